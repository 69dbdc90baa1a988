#include "engine/device/motion_file.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_motion(Data data) {
  try {
    const Motion motion = parse_motion(text_of(data), "motion.csv");
    for (const double share : {-0.1, 0.0, 0.37, 1.0, 1.1})
      static_cast<void>(motion.at(share * motion.duration_s()));
  } catch (const Error&) {
  }
}

std::vector<Bytes> motion_seeds() {
  const std::string header = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal";
  return {
      bytes_of(
          header +
          "\n0,0,0,1,1,0,0,0,0\n0.001,0,0,0.9,1,0,0,0,0.5\n0.002,0.1,0,0.8,0.7071,0.7071,0,0,1\n"),
      bytes_of("# bur = round-1.0\n" + header +
               ",b1,b2,bur\r\n1e3,0,0,1,1,0,0,0,0,1,0,2\r\n1000.5,0,0,-1e-1,1,0,0,0,0,0,1,0\r\n"),
      bytes_of("\xef\xbb\xbf" + header + "\n0,0,0,0.001,1,0,0,0,0\n1,0,0,0.002,1,0,0,0,0\n")};
}

}  // namespace cavum::fuzz
