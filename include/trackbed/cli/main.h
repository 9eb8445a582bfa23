#pragma once

namespace trackbed {

/// The program `trackbed`: parses the command line, runs the command, prints, and returns the exit
/// code. Exit codes: 0 as expected, 1 a bug, 2 bad input, 3 expectations not met, 130 interrupted.
/// Never throws; errors are printed to stderr. The program handles SIGINT, SIGTERM, SIGHUP and
/// SIGPIPE while it runs, and does not restore earlier handlers. Call Main once, from main().
int Main(int argc, char** argv);

}  // namespace trackbed
