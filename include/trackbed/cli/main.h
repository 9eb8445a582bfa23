#pragma once

namespace trackbed {

/// The program `trackbed`: reads the command line, does what its verb says, prints, and gives back
/// the exit code: 0 as expected, 2 bad input, 3 expectations not met, 130 interrupted, 1 a bug.
/// Throws nothing; errors go to stderr. While it runs it owns SIGINT, SIGTERM, SIGHUP and SIGPIPE
/// of the process and does not put back earlier handlers: call it once, from main().
int Main(int argc, char** argv);

}  // namespace trackbed
