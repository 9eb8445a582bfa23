#pragma once

namespace trackbed {

/// The program `trackbed`: parses the command line, runs the command, prints, and returns the exit
/// code: 0 as expected, 2 bad input, 3 expectations not met, 130 interrupted, 1 a bug. Throws
/// nothing; errors go to stderr. While it runs it owns SIGINT, SIGTERM, SIGHUP and SIGPIPE of the
/// process and does not restore earlier handlers: call it once, from main().
int Main(int argc, char** argv);

}  // namespace trackbed
