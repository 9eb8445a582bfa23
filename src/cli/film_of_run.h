#pragma once

#include <filesystem>
#include <string>

#include "src/cli/command.h"
#include "trackbed/render/film.h"

namespace trackbed::cli {

/// Adds --gl, which sets FilmOptions::gl.
void AddGlOption(const Command& command, std::string& gl);

/// Films a run folder with a progress bar. Ctrl-C cancels without writing a file.
void FilmRun(const std::filesystem::path& folder, const std::filesystem::path& output,
             const FilmOptions& options, bool quiet);

}  // namespace trackbed::cli
