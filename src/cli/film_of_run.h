#pragma once

#include <filesystem>
#include <string>

#include "src/cli/command.h"
#include "trackbed/render/film.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed::cli {

/// Adds the command line option --gl, which sets FilmOptions::gl.
void AddGlOption(const Command& command, std::string& gl);

/// Renders the film of a run from its run folder and shows a progress bar. After Ctrl-C, the
/// rendering ends without writing a file.
void FilmRun(const std::filesystem::path& folder, const std::filesystem::path& output,
             const FilmOptions& options, bool quiet);

/// Returns the options of the film that a scenario's section `render` describes.
FilmOptions FilmOptionsOf(const RenderSpec& render, const std::string& gl);

}  // namespace trackbed::cli
