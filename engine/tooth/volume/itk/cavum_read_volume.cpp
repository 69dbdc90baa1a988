// cavum-read-volume PATH: reads one volume for `cavum tooth import` and writes it to descriptor 3
// as volume_wire.h says. A program of its own, so that nothing that a damaged file does to the
// libraries that read it reaches Cavum.
#include <signal.h>
#include <sys/prctl.h>

#include <cstdio>

#include "engine/tooth/volume/itk/itk_volume.h"
#include "engine/tooth/volume/volume_wire.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr,
                 "cavum-read-volume PATH: a part of `cavum tooth import`, which calls it\n");
    return 2;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // whoever waits for the volume may be gone
  return cavum::serve_volume(argv[1], cavum::k_volume_descriptor);
}
