#include "ui/station/window.h"

#include <epoxy/gl.h>
#include <fmt/core.h>
// the functions of OpenGL come from epoxy: before GLFW
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "engine/base/error.h"
#include "ui/station/gpu.h"
#include "ui/station/picture_file.h"

namespace cavum::station {
namespace {

std::string glfw_reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

constexpr std::array<float, 4> k_font_px{18.0F, 26.0F, 46.0F, 14.5F};

/// A font with all letters that scenarios use; Dear ImGui's own when the computer has none.
void load_fonts(double scale) {
  constexpr const char* k_regular = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  constexpr const char* k_bold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
  static const std::array<ImWchar, 13> k_letters{0x20, 0x24f, 0x370, 0x52f, 0x2010, 0x205e, 0x2070, 0x209f, 0x2190, 0x22ff, 0x2500, 0x27bf, 0};
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  for (std::size_t i = 0; i < k_font_px.size(); ++i) {
    const char* file = i == 1 || i == 2 ? k_bold : k_regular;
    const auto px = static_cast<float>(k_font_px[i] * scale);
    if (std::filesystem::exists(file)) {
      atlas.AddFontFromFileTTF(file, px, nullptr, k_letters.data());
    } else {
      ImFontConfig config;
      config.SizePixels = px;
      atlas.AddFontDefault(&config);
    }
  }
}

}  // namespace

void push_font(Font font) { ImGui::PushFont(ImGui::GetIO().Fonts->Fonts[static_cast<int>(font)]); }
void pop_font() { ImGui::PopFont(); }

void spare_the_processor() noexcept { ::setenv("LP_NUM_THREADS", "1", 0); }

Window::Window(const std::string& title, int width, int height) {
  spare_the_processor();
  if (glfwInit() != GLFW_TRUE)
    throw Error("window", fmt::format("cannot be opened ({})", glfw_reason()), "start the station from a desktop, or under xvfb-run");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    const std::string why = glfw_reason();
    glfwTerminate();
    throw Error("window", fmt::format("has no OpenGL 3.3 ({})", why),
                "install the driver of the graphics card, or libgl1-mesa-dri for drawing without one");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  software_ = drawn_by_processor();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // every candidate finds the same screen
  io.LogFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  load_fonts(1.0);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::begin_frame() {
  glfwPollEvents();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  if (mouse_) {
    ImGui::GetIO().MousePos = {(*mouse_)[0], (*mouse_)[1]};
    ImGui::GetIO().MouseDown[0] = mouse_pressed_;
  }
  ImGui::NewFrame();
}

void Window::end_frame() {
  ImGui::Render();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  int w = 0, h = 0;
  glfwGetFramebufferSize(window_, &w, &h);
  glViewport(0, 0, w, h);
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
  glClearColor(back.x, back.y, back.z, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (!picture_.empty()) {
    std::vector<unsigned char> pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadBuffer(GL_BACK);
    glReadPixels(0, 0, w, h, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    write_png(picture_, w, h, pixels);
    picture_.clear();
  }
  glfwSwapBuffers(window_);
  if (pressed_ != 0) ImGui_ImplGlfw_KeyCallback(window_, pressed_, 0, GLFW_RELEASE, 0);
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
void Window::set_visible(bool visible) { visible ? glfwShowWindow(window_) : glfwHideWindow(window_); }

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

void Window::press(int key, bool held) {
  ImGui_ImplGlfw_KeyCallback(window_, key, 0, GLFW_PRESS, 0);
  pressed_ = held ? 0 : key;
}

void Window::release(int key) { ImGui_ImplGlfw_KeyCallback(window_, key, 0, GLFW_RELEASE, 0); }

void Window::point_at(float x, float y, bool pressed) {
  mouse_ = {x, y};
  mouse_pressed_ = pressed;
}

bool Window::wants_text() const { return ImGui::GetIO().WantTextInput; }

void Window::type(const std::string& text) {
  for (const char c : text) ImGui_ImplGlfw_CharCallback(window_, static_cast<unsigned char>(c));
}

}  // namespace cavum::station
