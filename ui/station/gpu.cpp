#include "ui/station/gpu.h"

#include <epoxy/gl.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "engine/base/error.h"

namespace cavum::station {
namespace {

unsigned compile(unsigned kind, const char* source) {
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  int ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == 0) {
    std::array<char, 1000> words{};
    glGetShaderInfoLog(shader, static_cast<int>(words.size()), nullptr, words.data());
    glDeleteShader(shader);
    throw Error("window", fmt::format("the graphics driver refuses a shader ({})", words.data()), "update the driver");
  }
  return shader;
}

}  // namespace

std::string renderer_name() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "";
}

bool drawn_by_processor() {
  const std::string name = renderer_name();
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos || name.find("swrast") != std::string::npos;
}

GpuVertex gpu_vertex(const glm::vec3& at_mm, const glm::vec3& normal, const std::array<std::uint8_t, 4>& colour) {
  const auto part = [](float v) { return static_cast<std::int8_t>(std::lround(glm::clamp(v, -1.0F, 1.0F) * 127.0F)); };
  return {{at_mm.x, at_mm.y, at_mm.z}, {part(normal.x), part(normal.y), part(normal.z), 0}, colour};
}

ShaderProgram::ShaderProgram(const char* vertex, const char* fragment) {
  const unsigned v = compile(GL_VERTEX_SHADER, vertex), f = compile(GL_FRAGMENT_SHADER, fragment);
  program_ = glCreateProgram();
  glAttachShader(program_, v);
  glAttachShader(program_, f);
  glLinkProgram(program_);
  glDeleteShader(v);
  glDeleteShader(f);
  int ok = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &ok);
  if (ok == 0) throw Error("window", "the graphics driver cannot link a shader", "update the driver");
}

ShaderProgram::~ShaderProgram() { glDeleteProgram(program_); }
void ShaderProgram::use() const { glUseProgram(program_); }
void ShaderProgram::set(const char* name, const glm::mat4& value) const {
  glUniformMatrix4fv(glGetUniformLocation(program_, name), 1, GL_FALSE, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec3& value) const {
  glUniform3fv(glGetUniformLocation(program_, name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, float value) const { glUniform1f(glGetUniformLocation(program_, name), value); }

void ShaderProgram::set(const char* name, std::span<const glm::vec3> values) const {
  glUniform3fv(glGetUniformLocation(program_, name), static_cast<int>(values.size()), glm::value_ptr(values.front()));
}

GpuMesh::~GpuMesh() {
  if (array_ == 0) return;
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &indices_);
}

GpuMesh::GpuMesh(GpuMesh&& other) noexcept
    : array_(std::exchange(other.array_, 0)),
      vertices_(std::exchange(other.vertices_, 0)),
      indices_(std::exchange(other.indices_, 0)),
      index_type_(other.index_type_),
      count_(std::exchange(other.count_, 0)) {}

GpuMesh& GpuMesh::operator=(GpuMesh&& other) noexcept {
  std::swap(array_, other.array_);
  std::swap(vertices_, other.vertices_);
  std::swap(indices_, other.indices_);
  std::swap(index_type_, other.index_type_);
  std::swap(count_, other.count_);
  return *this;
}

namespace {

/// OpenGL takes offsets as if they were addresses.
const void* place(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);  // NOLINT(performance-no-int-to-ptr)
}

template <class T>
void upload(unsigned target, unsigned buffer, std::span<const T> items) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(items.size_bytes()), items.data(), GL_DYNAMIC_DRAW);
}

}  // namespace

void GpuMesh::bind() {
  if (array_ == 0) {
    glGenVertexArrays(1, &array_);
    glGenBuffers(1, &vertices_);
    glGenBuffers(1, &indices_);
  }
  glBindVertexArray(array_);
}

void GpuMesh::put(std::span<const GpuVertex> vertices, std::span<const std::uint32_t> indices) {
  bind();
  upload(GL_ARRAY_BUFFER, vertices_, vertices);
  upload(GL_ELEMENT_ARRAY_BUFFER, indices_, indices);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(GpuVertex), place(offsetof(GpuVertex, at_mm)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_BYTE, GL_TRUE, sizeof(GpuVertex), place(offsetof(GpuVertex, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(GpuVertex), place(offsetof(GpuVertex, colour)));
  glBindVertexArray(0);
  index_type_ = GL_UNSIGNED_INT;
  count_ = static_cast<int>(indices.size());
}

void GpuMesh::put(const SurfacePatch& patch) {
  count_ = static_cast<int>(3 * patch.triangles.size());
  if (count_ == 0 && array_ == 0) return;
  bind();
  upload<PatchVertex>(GL_ARRAY_BUFFER, vertices_, patch.vertices);
  upload<std::array<std::uint16_t, 3>>(GL_ELEMENT_ARRAY_BUFFER, indices_, patch.triangles);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(PatchVertex), place(offsetof(PatchVertex, position_mm)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_SHORT, GL_TRUE, sizeof(PatchVertex), place(offsetof(PatchVertex, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 2, GL_UNSIGNED_BYTE, GL_FALSE, sizeof(PatchVertex), place(offsetof(PatchVertex, tissue)));
  glBindVertexArray(0);
  index_type_ = GL_UNSIGNED_SHORT;
}

void GpuMesh::draw() const {
  if (count_ == 0) return;
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, count_, index_type_, nullptr);
  glBindVertexArray(0);
}

RenderTarget::~RenderTarget() { free(); }

void RenderTarget::free() noexcept {
  if (frame_ == 0) return;
  glDeleteFramebuffers(1, &frame_);
  glDeleteFramebuffers(1, &shown_frame_);
  glDeleteRenderbuffers(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  glDeleteTextures(1, &shown_);
  frame_ = 0;
}

void RenderTarget::resize(int width, int height, int samples) {
  width = std::max(width, 1);
  height = std::max(height, 1);
  if (frame_ != 0 && width == width_ && height == height_ && samples == samples_) return;
  free();
  width_ = width;
  height_ = height;
  samples_ = samples;
  glGenFramebuffers(1, &frame_);
  glGenFramebuffers(1, &shown_frame_);
  glGenRenderbuffers(1, &colour_);
  glGenRenderbuffers(1, &depth_);
  glGenTextures(1, &shown_);
  const int each = samples > 1 ? samples : 0;
  glBindRenderbuffer(GL_RENDERBUFFER, colour_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, each, GL_RGBA8, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, each, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  glBindTexture(GL_TEXTURE_2D, shown_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, shown_frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, shown_, 0);
  const bool whole = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (!whole) throw Error("window", "the graphics driver has no room for a picture of this size", "make the window smaller");
}

void RenderTarget::begin(const glm::vec3& background) const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width_, height_);
  glClearColor(background.x, background.y, background.z, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void RenderTarget::end() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, shown_frame_);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace cavum::station
