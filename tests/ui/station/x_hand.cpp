#include "tests/ui/station/x_hand.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <dlfcn.h>

#include <chrono>
#include <thread>

namespace cavum::testing_station {
namespace {

Display* display_of(void* d) { return static_cast<Display*>(d); }
/// As Xrandr.h declares them, as far as they are read here.
struct RandrResources {
  Time timestamp, config_timestamp;
  int ncrtc;
  XID* crtcs;
  int noutput;
  XID* outputs;
};
struct RandrCrtc {
  Time timestamp;
  int x, y;
  unsigned width, height;
  XID mode;
};

/// Shows a mode (0: none) on the first screen; gives the mode that was shown, or nothing when the
/// server cannot.
bool set_screen(Display* display, XID mode, unsigned long* was) {
  void* library = ::dlopen("libXrandr.so.2", RTLD_NOW);
  if (library == nullptr) return false;
  const auto resources_of = reinterpret_cast<RandrResources* (*)(Display*, Window)>(
      ::dlsym(library, "XRRGetScreenResourcesCurrent"));
  const auto crtc_of = reinterpret_cast<RandrCrtc* (*)(Display*, RandrResources*, XID)>(
      ::dlsym(library, "XRRGetCrtcInfo"));
  const auto configure =
      reinterpret_cast<int (*)(Display*, RandrResources*, XID, Time, int, int, XID, unsigned short,
                               XID*, int)>(::dlsym(library, "XRRSetCrtcConfig"));
  RandrResources* all = resources_of(display, DefaultRootWindow(display));
  if (all == nullptr || all->ncrtc < 1 || all->noutput < 1) return false;
  if (was != nullptr) *was = crtc_of(display, all, all->crtcs[0])->mode;
  constexpr unsigned short k_upright = 1;
  const int answer = configure(display, all, all->crtcs[0], CurrentTime, 0, 0, mode, k_upright,
                               mode == 0 ? nullptr : all->outputs, mode == 0 ? 0 : 1);
  XSync(display, False);
  return answer == 0;
}

void rest(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

}  // namespace

XHand::XHand() {
  // libXtst has no header here that a build needs: four functions of it, as XTest.h declares them
  library_ = ::dlopen("libXtst.so.6", RTLD_NOW);
  if (library_ == nullptr) return;
  display_ = XOpenDisplay(nullptr);
  if (display_ == nullptr) return;
  fake_key_ = reinterpret_cast<int (*)(void*, unsigned, int, unsigned long)>(
      ::dlsym(library_, "XTestFakeKeyEvent"));
  fake_motion_ = reinterpret_cast<int (*)(void*, int, int, unsigned long)>(
      ::dlsym(library_, "XTestFakeRelativeMotionEvent"));
  fake_place_ = reinterpret_cast<int (*)(void*, int, int, int, unsigned long)>(
      ::dlsym(library_, "XTestFakeMotionEvent"));
  fake_button_ = reinterpret_cast<int (*)(void*, unsigned, int, unsigned long)>(
      ::dlsym(library_, "XTestFakeButtonEvent"));
}

XHand::~XHand() {
  if (display_ != nullptr) XCloseDisplay(display_of(display_));
  if (library_ != nullptr) ::dlclose(library_);
}

void XHand::key(const std::string& key, bool down) const {
  fake_key_(display_, XKeysymToKeycode(display_of(display_), XStringToKeysym(key.c_str())),
            down ? 1 : 0, 0);
  XFlush(display_of(display_));
}

void XHand::tap(const std::string& name, int ms) const {
  key(name, true);
  rest(ms);
  key(name, false);
}

void XHand::move(int x, int y) const {
  fake_motion_(display_, x, y, 0);
  XFlush(display_of(display_));
}

void XHand::point_at(int x, int y) const {
  fake_place_(display_, 0, x, y, 0);
  XFlush(display_of(display_));
}

void XHand::button(unsigned number, bool down) const {
  fake_button_(display_, number, down ? 1 : 0, 0);
  XFlush(display_of(display_));
}

void XHand::click(unsigned number, int ms) const {
  button(number, true);
  rest(ms);
  button(number, false);
}

std::optional<std::pair<int, int>> XHand::see(unsigned long colour) const {
  constexpr int k_min_wide = 60;
  Display* d = display_of(display_);
  const int wide = DisplayWidth(d, DefaultScreen(d)), high = DisplayHeight(d, DefaultScreen(d));
  XImage* image = XGetImage(d, DefaultRootWindow(d), 0, 0, static_cast<unsigned>(wide),
                            static_cast<unsigned>(high), AllPlanes, ZPixmap);
  if (image == nullptr) return {};
  // rows of the colour's longest run that lie over one another
  int best_rows = 0, rows = 0, last = -1;
  std::optional<std::pair<int, int>> found;
  for (int y = 0; y < high; ++y) {
    int run = 0, longest = 0, end = 0;
    for (int x = 0; x < wide; ++x) {
      run = (XGetPixel(image, x, y) & 0xffffffUL) == colour ? run + 1 : 0;
      if (run > longest) {
        longest = run;
        end = x;
      }
    }
    const int middle = end - longest / 2;
    const bool there = longest >= k_min_wide;
    rows = !there                                                                  ? 0
           : last >= 0 && middle > last - k_min_wide && middle < last + k_min_wide ? rows + 1
                                                                                   : 1;
    last = there ? middle : -1;
    if (rows > best_rows) {
      best_rows = rows;
      found = std::pair{end - 4, y - 2};  // its right edge: no letters
    }
  }
  XDestroyImage(image);
  return best_rows >= 8 ? found : std::nullopt;
}

void XHand::take_the_keyboard(int ms) const {
  Display* d = display_of(display_);
  const Window other = XCreateSimpleWindow(d, DefaultRootWindow(d), 0, 0, 40, 40, 0, 0, 0);
  XMapRaised(d, other);
  XSync(d, False);
  rest(100);
  XSetInputFocus(d, other, RevertToParent, CurrentTime);
  XSync(d, False);
  rest(ms);
  XDestroyWindow(d, other);
  XSync(d, False);
}

unsigned long XHand::window_of(const std::string& title) const {
  Display* d = display_of(display_);
  Window root = 0, parent = 0, *children = nullptr, found = 0;
  unsigned count = 0;
  if (XQueryTree(d, DefaultRootWindow(d), &root, &parent, &children, &count) == 0) return 0;
  for (unsigned i = 0; i < count; ++i) {
    char* name = nullptr;
    if (XFetchName(d, children[i], &name) != 0 && name != nullptr) {
      if (name == title) found = children[i];
      XFree(name);
    }
  }
  if (children != nullptr) XFree(children);
  return found;
}

bool XHand::ask_to_close(const std::string& title) const {
  Display* d = display_of(display_);
  const Window window = window_of(title);
  if (window == 0) return false;
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window;
  event.xclient.message_type = XInternAtom(d, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(d, "WM_DELETE_WINDOW", False));
  event.xclient.data.l[1] = CurrentTime;
  XSendEvent(d, window, False, NoEventMask, &event);
  XSync(d, False);
  return true;
}

bool XHand::unplug_screen() { return set_screen(display_of(display_), 0, &mode_); }
bool XHand::plug_screen() { return set_screen(display_of(display_), mode_, nullptr); }

std::string XHand::size_of(const std::string& title) const {
  const Window window = window_of(title);
  XWindowAttributes a{};
  if (window == 0 || XGetWindowAttributes(display_of(display_), window, &a) == 0) return "none";
  return std::to_string(a.width) + " x " + std::to_string(a.height) + " at " + std::to_string(a.x) +
         ", " + std::to_string(a.y);
}

}  // namespace cavum::testing_station
