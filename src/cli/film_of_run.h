#pragma once

#include <filesystem>
#include <string>

#include "src/cli/command.h"
#include "trackbed/render/film.h"

namespace trackbed::cli {

/// Adds the option --gl, which sets FilmOptions::gl.
void AddGlOption(const Command& command, std::string& gl);

/// Films a run folder with a progress bar. Ctrl-C cancels the film, and no file is written.
void FilmRun(const std::filesystem::path& folder, const std::filesystem::path& output,
             const FilmOptions& options, bool quiet);

}  // namespace trackbed::cli
