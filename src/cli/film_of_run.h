#pragma once

#include <filesystem>
#include <string>

#include "src/cli/command.h"
#include "trackbed/render/film.h"

namespace trackbed::cli {

/// Adds the command line option --gl, which sets FilmOptions::gl.
void AddGlOption(const Command& command, std::string& gl);

/// Renders the film of a run folder and shows a progress bar. Ctrl-C cancels the rendering, and no
/// file is written.
void FilmRun(const std::filesystem::path& folder, const std::filesystem::path& output,
             const FilmOptions& options, bool quiet);

}  // namespace trackbed::cli
