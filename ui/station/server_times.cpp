#include "ui/station/server_times.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <functional>

// of GLFW, whose own header of them asks for those of RandR besides
extern "C" Display* glfwGetX11Display(void);
extern "C" Window glfwGetX11Window(GLFWwindow* window);

namespace cavum::station {
namespace {

using Look = std::function<void(const XEvent&)>;

/// Takes no event out of the queue.
Bool look_only(Display*, XEvent* event, XPointer look) {
  (*reinterpret_cast<const Look*>(look))(*event);
  return False;
}

struct Awaited {
  Window window;
  Atom atom;
};

Bool is_awaited(Display*, XEvent* event, XPointer awaited) {
  const auto* a = reinterpret_cast<const Awaited*>(awaited);
  return event->type == PropertyNotify && event->xproperty.window == a->window &&
                 event->xproperty.atom == a->atom
             ? True
             : False;
}

}  // namespace

ServerTimes::ServerTimes(GLFWwindow* window, double (*now_s)()) : now_s_(now_s) {
  Display* display = glfwGetX11Display();
  // a change of a property that changes nothing comes back with the server's time; GLFW listens for
  // those of its windows
  Awaited awaited{glfwGetX11Window(window), XInternAtom(display, "CAVUM_CLOCK", False)};
  const unsigned char nothing = 0;
  XChangeProperty(display, awaited.window, awaited.atom, XA_INTEGER, 8, PropModeAppend, &nothing,
                  0);
  XEvent event;
  XIfEvent(display, &event, is_awaited, reinterpret_cast<XPointer>(&awaited));
  zero_ms_ = static_cast<std::uint32_t>(event.xproperty.time);
  zero_s_ = now_s_();
}

double ServerTimes::own_s(std::uint32_t server_ms) const {
  return zero_s_ +
         1e-3 * static_cast<double>(static_cast<std::int32_t>(
                    server_ms - zero_ms_));  // the server's clock begins anew after 49 days
}

void ServerTimes::look() {
  seen_.clear();
  Display* display = glfwGetX11Display();
  XEventsQueued(display, QueuedAfterReading);
  const Look note = [this](const XEvent& e) {
    const bool down = e.type == KeyPress || e.type == ButtonPress;
    if (e.type == KeyPress || e.type == KeyRelease)
      seen_.push_back({true, down, static_cast<int>(e.xkey.keycode),
                       own_s(static_cast<std::uint32_t>(e.xkey.time))});
    if (e.type == ButtonPress || e.type == ButtonRelease)
      seen_.push_back({false, down, static_cast<int>(e.xbutton.button),
                       own_s(static_cast<std::uint32_t>(e.xbutton.time))});
  };
  XEvent none;
  XCheckIfEvent(display, &none, look_only, reinterpret_cast<XPointer>(const_cast<Look*>(&note)));
}

double ServerTimes::take(bool key, int code, bool down) {
  const auto found = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& s) {
    return s.key == key && s.code == code && s.down == down;
  });
  if (found == seen_.end()) return now_s_();
  const double t_s = found->t_s;
  seen_.erase(found);
  return std::min(t_s, now_s_());
}

double ServerTimes::of_key(int scancode, bool down) { return take(true, scancode, down); }

double ServerTimes::of_button(int button, bool down) {
  // 4 to 7 are the wheel's
  constexpr int k_middle = 2, k_wheel_buttons = 4;
  const int x11 = button == GLFW_MOUSE_BUTTON_LEFT     ? 1
                  : button == GLFW_MOUSE_BUTTON_RIGHT  ? 3
                  : button == GLFW_MOUSE_BUTTON_MIDDLE ? k_middle
                                                       : button + 1 + k_wheel_buttons;
  return take(false, x11, down);
}

}  // namespace cavum::station
