#pragma once

namespace trackbed {

/// The program `trackbed`: parses the command line, runs the command, prints, and returns the exit
/// code. The exit code is 0 on success, 1 for a bug in the program, and 2 for invalid input. The
/// exit code is 3 if expectations of a run are not met, and 130 if the program was interrupted.
/// Main never throws; it prints errors to stderr. The program handles SIGINT, SIGTERM, SIGHUP and
/// SIGPIPE while it runs, and does not restore the handlers that were set before. Call Main only
/// once per process, from main().
int Main(int argc, char** argv);

}  // namespace trackbed
