#include "trackbed/cli/main.h"

int main(int argc, char** argv) {
  return trackbed::Main(argc, argv);
}
