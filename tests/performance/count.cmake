# Counts the instructions of one unit of work: those of MORE units minus those of FEW, per unit. The
# count does not depend on the machine's load. Another version of its mathematical library changes
# the count by some percent.
#
#   cmake -DVALGRIND= -DPROGRAM= -DCASE= -DFEW= -DMORE= -DMOST= -DWORK= -P count.cmake
function(count units result)
  execute_process(
    COMMAND ${VALGRIND} --tool=callgrind --callgrind-out-file=${WORK}/${CASE}.callgrind ${PROGRAM}
            ${CASE} ${units}
    RESULT_VARIABLE failed
    OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(failed OR NOT output MATCHES "Collected : ([0-9]+)")
    message(FATAL_ERROR "${CASE}: no count of ${units}:\n${output}")
  endif()
  set(${result} ${CMAKE_MATCH_1} PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${WORK})
count(${FEW} few)
count(${MORE} more)
math(EXPR each "(${more} - ${few}) / (${MORE} - ${FEW})")
message("${CASE}: ${each} instructions, at most ${MOST}")
math(EXPR least "${MOST} / 2")
if(each GREATER MOST)
  message(FATAL_ERROR "more than allowed: find out why (callgrind_annotate ${WORK}/${CASE}.callgrind)")
elseif(each LESS least)
  message(FATAL_ERROR "less than half of what is allowed: lower the bound in tests/CMakeLists.txt")
endif()
