#include "ui/station/window.h"

#include <epoxy/gl.h>
// the functions of OpenGL come from epoxy: before GLFW
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <thread>
#include <vector>

#include "engine/base/error.h"
#include "ui/station/gpu.h"
#include "ui/station/picture_file.h"

namespace cavum::station {
namespace {

Message glfw_reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? Message(Name{text}) : msg("no reason given");
}

constexpr std::array<float, 4> k_font_px{18.0F, 26.0F, 46.0F, 14.5F};

/// A font with all letters that scenarios use; Dear ImGui's own when the computer has none.
void load_fonts(double scale) {
  constexpr const char* k_regular = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  constexpr const char* k_bold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
  static const std::array<ImWchar, 13> k_letters{
      0x20, 0x24f, 0x370, 0x52f, 0x2010, 0x205e, 0x2070, 0x209f, 0x2190, 0x22ff, 0x2500, 0x27bf, 0};
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  for (std::size_t i = 0; i < k_font_px.size(); ++i) {
    const char* file = i == 1 || i == 2 ? k_bold : k_regular;
    const auto px = static_cast<float>(k_font_px[i] * scale);
    if (std::filesystem::exists(file)) {
      atlas.AddFontFromFileTTF(
          file, px, nullptr,
          i == 2 ? nullptr : k_letters.data());  // the clock has no foreign letters
    } else {
      ImFontConfig config;
      config.SizePixels = px;
      atlas.AddFontDefault(&config);
    }
  }
}

double own_clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<GLFWmonitor*> monitors() {
  int count = 0;
  GLFWmonitor** all = glfwGetMonitors(&count);
  return {all, all + count};
}

int monitor_count() { return static_cast<int>(monitors().size()); }

/// Null when there is none.
GLFWmonitor* find_monitor(const std::string& wanted) {
  int number = 0;
  for (GLFWmonitor* m : monitors())
    if (wanted == std::to_string(++number) || wanted == glfwGetMonitorName(m)) return m;
  return nullptr;
}

GLFWmonitor* monitor_of(const std::string& wanted) {
  if (GLFWmonitor* found = find_monitor(wanted)) return found;
  List known{{}, true};
  int number = 0;
  for (GLFWmonitor* m : monitors()) {
    const GLFWvidmode* mode = glfwGetVideoMode(m);
    known.items.push_back(
        msg("{} ({}, {} × {})", ++number, glfwGetMonitorName(m), mode->width, mode->height));
  }
  throw Error(Name{"--monitor " + wanted}, msg("is not there"),
              known.items.empty() ? msg("plug one in") : msg("name one of {}", known));
}

}  // namespace

void push_font(Font font) { ImGui::PushFont(ImGui::GetIO().Fonts->Fonts[static_cast<int>(font)]); }
void pop_font() { ImGui::PopFont(); }

void spare_the_processor() noexcept { ::setenv("LP_NUM_THREADS", "1", 0); }

void reserve_picture_memory() {
  constexpr std::size_t
      k_blocks = 384,
      k_block_bytes =
          std::size_t{64} *
          1024;  // 24 MB: ten minutes of hard work took 8, a picture takes 8 for a moment
  mallopt(M_TRIM_THRESHOLD, 4 * static_cast<int>(k_blocks * k_block_bytes));
  std::vector<std::vector<char>> blocks(k_blocks);
  for (auto& block : blocks) block.assign(k_block_bytes, 1);
}

Window::Window(const WindowOptions& options)
    : monitor_(options.monitor), full_screen_(options.full_screen) {
  spare_the_processor();
  if (glfwInit() != GLFW_TRUE)
    throw Error(msg("window"), msg("cannot be opened ({})", glfw_reason()),
                msg("start the station from a desktop, or under xvfb-run"));
  try {
    open(options);
  } catch (...) {
    glfwTerminate();
    throw;
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  software_ = drawn_by_processor();
  times_ = std::make_unique<ServerTimes>(window_, &own_clock_s);
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // every candidate finds the same screen
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  load_fonts(1.0);
  ImGui_ImplGlfw_InitForOpenGL(window_, false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  listen();
}

void Window::open(const WindowOptions& options) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_AUTO_ICONIFY,
                 GLFW_FALSE);  // an exam is not hidden because something else has the keyboard
  GLFWmonitor* monitor = monitor_.empty() ? nullptr : monitor_of(monitor_);
  int width = options.width, height = options.height;
  if (full_screen_) {
    if (monitor == nullptr) monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr)
      throw Error(Name{"--kiosk"}, msg("there is no monitor to fill"), msg("plug one in"));
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    width = mode->width;
    height = mode->height;
  }
  window_ = glfwCreateWindow(width, height, options.title.c_str(), full_screen_ ? monitor : nullptr,
                             nullptr);
  if (window_ == nullptr)
    throw Error(
        msg("window"), msg("has no OpenGL 3.3 ({})", glfw_reason()),
        msg("install the driver of the graphics card, or libgl1-mesa-dri for drawing without one"));
  if (monitor == nullptr || full_screen_) return;
  int x = 0, y = 0;
  glfwGetMonitorPos(monitor, &x, &y);
  glfwSetWindowPos(window_, x, y);
}

Window::~Window() {
  glfwSetMonitorCallback(nullptr);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::push(InputEvent event) {
  if (event.t_s == 0.0) event.t_s = own_clock_s();
  input_.push(event);
}

void Window::moved_to(double x, double y) {
  const auto to_x = static_cast<float>(x), to_y = static_cast<float>(y);
  if (mouse_known_ && (to_x != mouse_x_ || to_y != mouse_y_))
    push({.kind = InputEvent::Kind::motion, .x = to_x - mouse_x_, .y = to_y - mouse_y_});
  mouse_x_ = to_x;
  mouse_y_ = to_y;
  mouse_known_ = true;
}

/// All that GLFW tells goes into the queue, and to Dear ImGui only when it is played.
void Window::listen() {
  using Kind = InputEvent::Kind;
  static Window* one;  // GLFW's monitors belong to no window
  one = this;
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    if (action == GLFW_REPEAT) return;
    Window& self = *static_cast<Window*>(glfwGetWindowUserPointer(w));
    const bool down = action == GLFW_PRESS;
    InputEvent event{
        .kind = Kind::key, .code = key, .down = down, .t_s = self.times_->of_key(scancode, down)};
    if (event.t_s == 0.0) event.t_s = own_clock_s();
    self.input_.push_key(event, modifiers);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned letter) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))
        ->push({.kind = Kind::text, .code = static_cast<int>(letter)});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    Window& self = *static_cast<Window*>(glfwGetWindowUserPointer(w));
    const bool down = action == GLFW_PRESS;
    self.push({.kind = Kind::button,
               .code = button,
               .down = down,
               .t_s = self.times_->of_button(button, down)});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))
        ->push({.kind = Kind::wheel, .x = static_cast<float>(x), .y = static_cast<float>(y)});
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))->moved_to(x, y);
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int inside) {
    Window& self = *static_cast<Window*>(glfwGetWindowUserPointer(w));
    if (inside == GLFW_FALSE && !self.captured_) self.mouse_known_ = false;
  });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int won) {
    static_cast<Window*>(glfwGetWindowUserPointer(w))
        ->push({.kind = Kind::focus, .down = won == GLFW_TRUE});
  });
  glfwSetWindowIconifyCallback(
      window_, [](GLFWwindow* w,
                  int iconified) {  // not every window manager takes the keyboard away with it
        if (iconified == GLFW_TRUE)
          static_cast<Window*>(glfwGetWindowUserPointer(w))->push({.kind = Kind::focus});
      });
  glfwSetMonitorCallback([](GLFWmonitor*, int event) {
    one->push({.kind = Kind::screens, .code = monitor_count(), .down = event == GLFW_CONNECTED});
  });
}

void Window::take_events() {
  times_->look();
  glfwPollEvents();
}

void Window::begin_frame() {
  take_events();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  for (const InputEvent& e : input_.play(own_clock_s())) switch (e.kind) {
      case InputEvent::Kind::key:
        ImGui_ImplGlfw_KeyCallback(window_, e.code, 0, e.down ? GLFW_PRESS : GLFW_RELEASE, 0);
        break;
      case InputEvent::Kind::text:
        io.AddInputCharacter(static_cast<unsigned>(e.code));
        break;
      case InputEvent::Kind::wheel:
        io.MouseWheel += e.y;
        break;
      default:
        break;
    }
  constexpr float k_nowhere = -std::numeric_limits<float>::max();
  io.MousePos =
      captured_ || !mouse_known_ ? ImVec2{k_nowhere, k_nowhere} : ImVec2{mouse_x_, mouse_y_};
  for (int i = 0; i < ImGuiMouseButton_COUNT; ++i)
    io.MouseDown[i] = !captured_ && input_.button_down(i);
  ImGui::NewFrame();
}

void Window::rest(std::chrono::steady_clock::time_point began, double hz) const {
  const double least_s = 1.0 / (hz > 0 ? hz : software_ ? 25.0 : 120.0);
  std::this_thread::sleep_until(began + std::chrono::duration<double>(least_s));
}

void Window::walk_by_keys(bool may) {
  int& flags = ImGui::GetIO().ConfigFlags;
  flags = may ? flags | ImGuiConfigFlags_NavEnableKeyboard
              : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
}

void Window::keep_words(const std::string& path) {
  std::filesystem::remove(path);
  words_ = path;
  ImGui::GetIO().LogFilename = words_.c_str();
}

void Window::end_frame() {
  ImGui::Render();
  ImGui::GetIO().LogFilename = nullptr;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  int w = 0, h = 0;
  glfwGetFramebufferSize(window_, &w, &h);
  glViewport(0, 0, w, h);
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
  glClearColor(back.x, back.y, back.z, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (!picture_.empty()) {
    std::vector<unsigned char> pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                                      3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_BACK);
    glReadPixels(0, 0, w, h, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    write_png(picture_, w, h, pixels);
    picture_.clear();
  }
  glfwSwapBuffers(window_);
  if (pressed_ != 0) release(pressed_);
  pressed_ = 0;
}

void Window::set_text_scale(double scale) {
  load_fonts(scale);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

bool Window::closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
void Window::ask_to_close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Window::stay_open() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }
void Window::set_visible(bool visible) {
  visible ? glfwShowWindow(window_) : glfwHideWindow(window_);
}

int Window::width() const {
  int w = 0, h = 0;
  glfwGetFramebufferSize(window_, &w, &h);
  return w;
}

int Window::height() const {
  int w = 0, h = 0;
  glfwGetFramebufferSize(window_, &w, &h);
  return h;
}

double Window::screen_scale() const {
  // text of 18 pixels suits a window of 1600 x 900 and less
  constexpr double k_width = 1600.0, k_height = 900.0, k_largest = 4.0;
  float desktop_x = 1.0F, desktop_y = 1.0F;
  glfwGetWindowContentScale(window_, &desktop_x, &desktop_y);
  const double by_size = std::min(width() / k_width, height() / k_height);
  return std::clamp(
      std::max({static_cast<double>(desktop_x), static_cast<double>(desktop_y), by_size}), 1.0,
      k_largest);
}

void Window::capture_mouse(bool captured) {
  if (captured == captured_) return;
  captured_ = captured;
  if (glfwRawMouseMotionSupported() == GLFW_TRUE)
    glfwSetInputMode(window_, GLFW_RAW_MOUSE_MOTION, captured ? GLFW_TRUE : GLFW_FALSE);
  glfwSetInputMode(window_, GLFW_CURSOR, captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  // where it goes on from is no way that a hand made; the first way from there is one
  double x = 0, y = 0;
  glfwGetCursorPos(window_, &x, &y);
  mouse_x_ = static_cast<float>(x);
  mouse_y_ = static_cast<float>(y);
  mouse_known_ = true;
}

void Window::come_back() {
  if (full_screen_) {
    GLFWmonitor* monitor = monitor_.empty() ? glfwGetPrimaryMonitor() : find_monitor(monitor_);
    if (monitor == nullptr) monitor = glfwGetPrimaryMonitor();
    if (monitor != nullptr && glfwGetWindowMonitor(window_) != monitor) {
      const GLFWvidmode* mode = glfwGetVideoMode(monitor);
      glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    }
  }
  glfwRestoreWindow(window_);
  glfwShowWindow(window_);
  glfwFocusWindow(window_);
}

void Window::press(int key, bool held) {
  push({.kind = InputEvent::Kind::key, .code = key, .down = true});
  pressed_ = held ? 0 : key;
}

void Window::release(int key) { push({.kind = InputEvent::Kind::key, .code = key, .down = false}); }

void Window::point_at(float x, float y, bool pressed) {
  moved_to(static_cast<double>(x), static_cast<double>(y));
  push({.kind = InputEvent::Kind::button, .code = GLFW_MOUSE_BUTTON_LEFT, .down = pressed});
}

bool Window::wants_text() const { return ImGui::GetIO().WantTextInput; }

void Window::type(const std::string& text) {
  for (const char c : text)
    push({.kind = InputEvent::Kind::text, .code = static_cast<unsigned char>(c)});
}

}  // namespace cavum::station
