# Writes OUTPUT, a C++ file that defines the texts declared in src/report/page_text.h.

# Replaces the placeholders in the report's template page.html, which have the form <!-- part -->
# and are each on a separate line.
file(READ ${PAGE}/page.html page)
function(put part text)
  string(FIND "${page}" "<!-- ${part} -->" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "page.html has no place for ${part}")
  endif()
  string(LENGTH "<!-- ${part} -->" length)
  math(EXPR after "${place} + ${length}")
  string(SUBSTRING "${page}" 0 ${place} before)
  string(SUBSTRING "${page}" ${after} -1 rest)
  set(page
      "${before}${text}${rest}"
      PARENT_SCOPE)
endfunction()

# Sets the variable `source` to the expression (a hash) that allows the script or style `text` in
# the page's Content-Security-Policy.
function(allow source text)
  string(SHA256 digest "${text}")
  string(TOUPPER ${digest} digest)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E echo_append ${digest}
    COMMAND basenc --base16 --decode
    COMMAND basenc --base64
    OUTPUT_VARIABLE encoded
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(${source}
      "'sha256-${encoded}'"
      PARENT_SCOPE)
endfunction()

file(READ ${DYGRAPHS_STYLE} library_style)
file(READ ${PAGE}/page.colors.css colors)
file(READ ${PAGE}/page.css style)
set(style "\n${library_style}\n${colors}${style}")
allow(style_source "${style}")
put(style "<style>${style}</style>")

file(READ ${D3_LICENSE} d3_license)
file(READ ${DYGRAPHS_LICENSE} dygraphs_license)
file(READ ${THREE_LICENSE} three_license)
put(licenses
    "<script type=\"text/plain\" id=\"licenses\">d3\n\n${d3_license}\n\ndygraphs\n\n${dygraphs_license}\n\nthree.js\n\n${three_license}</script>"
)

file(READ ${D3_SCRIPT} d3)
file(READ ${DYGRAPHS_SCRIPT} dygraphs)
allow(d3_source "${d3}")
allow(dygraphs_source "${dygraphs}")
put(libraries "<script>${d3}</script>\n<script>${dygraphs}</script>")

set(script "\n\"use strict\";\n")
foreach(part IN ITEMS base map events charts phase_planes series differences film tables answer vehicle scenery
        tyres wind replay study_statistics study_map study_answer study_search study identification path_check main)
  file(READ ${PAGE}/${part}.js text)
  string(APPEND script "${text}\n")
endforeach()
allow(script_source "${script}")
put(script "<script>${script}</script>")
# Keep the 3D libraries in separate texts, because only reports of runs contain a 3D scene.
file(READ ${THREE_SCRIPT} three)
file(READ ${ORBIT_CONTROLS_SCRIPT} orbit_controls)
allow(three_source "${three}")
allow(orbit_controls_source "${orbit_controls}")
set(scene_libraries "<script>${three}</script>\n<script>${orbit_controls}</script>\n")
file(READ ${PAGE}/canvas.js canvas)
set(canvas "\n\"use strict\";\n${canvas}")
allow(canvas_source "${canvas}")
set(scene_canvas "<script>${canvas}</script>\n")
put("style source" "${style_source}")
put("script sources"
    "${d3_source} ${dygraphs_source} ${three_source} ${orbit_controls_source} ${canvas_source} ${script_source}")

# Only the page of a live run (trackbed watch) contains the script live.js and may connect to the
# server of `trackbed watch`.
file(READ ${PAGE}/live.js live)
set(live "\n\"use strict\";\n${live}")
allow(live_source "${live}")
set(live_source " ${live_source}; connect-src 'self'")
set(live_script "<script>${live}</script>\n")

# Split the page at the placeholders of texts that differ between reports, such as the title and the
# data.
foreach(cut IN ITEMS live_source title data live_script)
  string(REPLACE "_" " " mark ${cut})
  string(FIND "${page}" "<!-- ${mark} -->" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "page.html has no place for ${mark}")
  endif()
  string(SUBSTRING "${page}" 0 ${place} before_${cut})
  string(LENGTH "<!-- ${mark} -->" length)
  math(EXPR place "${place} + ${length}")
  string(SUBSTRING "${page}" ${place} -1 page)
endforeach()

set(delimiter trackbed)
file(
  WRITE ${OUTPUT}
  "#include \"src/report/page_text.h\"

namespace trackbed {

const std::string_view kPageBeforeLiveSource = R\"${delimiter}(${before_live_source})${delimiter}\";
const std::string_view kLiveSource = R\"${delimiter}(${live_source})${delimiter}\";
const std::string_view kPageBeforeTitle = R\"${delimiter}(${before_title})${delimiter}\";
const std::string_view kPageBeforeData = R\"${delimiter}(${before_data})${delimiter}\";
const std::string_view kSceneCanvas = R\"${delimiter}(${scene_canvas})${delimiter}\";
const std::string_view kSceneLibraries = R\"${delimiter}(${scene_libraries})${delimiter}\";
const std::string_view kPageBeforeLiveScript = R\"${delimiter}(${before_live_script})${delimiter}\";
const std::string_view kLiveScript = R\"${delimiter}(${live_script})${delimiter}\";
const std::string_view kPageEnd = R\"${delimiter}(${page})${delimiter}\";

}  // namespace trackbed
")
