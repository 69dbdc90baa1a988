// When keys and buttons were really pressed: the X server's times of the events that GLFW is about
// to hand out, which it does not tell.
#pragma once

#include <cstdint>
#include <vector>

struct GLFWwindow;

namespace cavum::station {

class ServerTimes {
 public:
  /// Asks the server for its clock, once. `now_s`: the own clock.
  ServerTimes(GLFWwindow* window, double (*now_s)());
  /// Just before GLFW hands out what waits.
  void look();
  /// Of the next such event in the order in which they came; now, for one that came meanwhile.
  /// `code`: scancode of GLFW, or its button.
  [[nodiscard]] double of_key(int scancode, bool down);
  [[nodiscard]] double of_button(int button, bool down);

 private:
  struct Seen {
    bool key = false, down = false;
    int code = 0;
    double t_s = 0.0;
  };
  [[nodiscard]] double take(bool key, int code, bool down);
  [[nodiscard]] double own_s(std::uint32_t server_ms) const;

  double (*now_s_)();
  std::uint32_t zero_ms_ = 0;  // of the server, when the own clock stood at zero_s_
  double zero_s_ = 0.0;
  std::vector<Seen> seen_;
};

}  // namespace cavum::station
