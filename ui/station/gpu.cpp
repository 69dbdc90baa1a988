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
    throw Error(msg("window"), msg("the graphics driver refuses a shader ({})", words.data()),
                msg("update the driver"));
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
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos ||
         name.find("swrast") != std::string::npos;
}

GpuVertex gpu_vertex(const glm::vec3& at_mm, const glm::vec3& normal,
                     const std::array<std::uint8_t, 4>& colour) {
  const auto part = [](float v) {
    return static_cast<std::int8_t>(std::lround(glm::clamp(v, -1.0F, 1.0F) * 127.0F));
  };
  return {{at_mm.x, at_mm.y, at_mm.z}, {part(normal.x), part(normal.y), part(normal.z), 0}, colour};
}

ShaderProgram::ShaderProgram(const std::string& vertex, const std::string& fragment,
                             const std::string& defines) {
  std::string head = "#version 330 core\n";
  for (std::size_t at = 0; at < defines.size();) {
    const std::size_t end = std::min(defines.find(' ', at), defines.size());
    std::string word = defines.substr(at, end - at);
    std::replace(word.begin(), word.end(), '=', ' ');
    head += "#define " + word + "\n";
    at = end + 1;
  }
  const unsigned v = compile(GL_VERTEX_SHADER, (head + vertex).c_str()),
                 f = compile(GL_FRAGMENT_SHADER, (head + fragment).c_str());
  program_ = glCreateProgram();
  glAttachShader(program_, v);
  glAttachShader(program_, f);
  glLinkProgram(program_);
  glDeleteShader(v);
  glDeleteShader(f);
  int ok = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &ok);
  if (ok == 0)
    throw Error(msg("window"), msg("the graphics driver cannot link a shader"),
                msg("update the driver"));
}

ShaderProgram::~ShaderProgram() { glDeleteProgram(program_); }
void ShaderProgram::use() const { glUseProgram(program_); }
void ShaderProgram::set(const char* name, const glm::mat4& value) const {
  glUniformMatrix4fv(glGetUniformLocation(program_, name), 1, GL_FALSE, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec3& value) const {
  glUniform3fv(glGetUniformLocation(program_, name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::mat3& value) const {
  glUniformMatrix3fv(glGetUniformLocation(program_, name), 1, GL_FALSE, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec2& value) const {
  glUniform2fv(glGetUniformLocation(program_, name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec4& value) const {
  glUniform4fv(glGetUniformLocation(program_, name), 1, glm::value_ptr(value));
}
void ShaderProgram::set_texture(const char* name, int unit, unsigned kind, unsigned texture) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<unsigned>(unit));
  glBindTexture(kind, texture);
  glActiveTexture(GL_TEXTURE0);
  glUniform1i(glGetUniformLocation(program_, name), unit);
}
void ShaderProgram::set(const char* name, float value) const {
  glUniform1f(glGetUniformLocation(program_, name), value);
}

void ShaderProgram::set(const char* name, std::span<const glm::vec3> values) const {
  glUniform3fv(glGetUniformLocation(program_, name), static_cast<int>(values.size()),
               glm::value_ptr(values.front()));
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
      count_(std::exchange(other.count_, 0)) {}

GpuMesh& GpuMesh::operator=(GpuMesh&& other) noexcept {
  std::swap(array_, other.array_);
  std::swap(vertices_, other.vertices_);
  std::swap(indices_, other.indices_);
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
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(GpuVertex),
                        place(offsetof(GpuVertex, at_mm)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_BYTE, GL_TRUE, sizeof(GpuVertex),
                        place(offsetof(GpuVertex, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(GpuVertex),
                        place(offsetof(GpuVertex, colour)));
  glBindVertexArray(0);
  count_ = static_cast<int>(indices.size());
}

void GpuMesh::put(std::span<const ToothVertex> vertices, std::span<const std::uint32_t> indices) {
  count_ = static_cast<int>(indices.size());
  if (count_ == 0 && array_ == 0) return;
  bind();
  upload(GL_ARRAY_BUFFER, vertices_, vertices);
  upload(GL_ELEMENT_ARRAY_BUFFER, indices_, indices);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(ToothVertex),
                        place(offsetof(ToothVertex, at_mm)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_SHORT, GL_TRUE, sizeof(ToothVertex),
                        place(offsetof(ToothVertex, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 2, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ToothVertex),
                        place(offsetof(ToothVertex, open)));
  glEnableVertexAttribArray(3);
  glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_FALSE, sizeof(ToothVertex),
                        place(offsetof(ToothVertex, tissue)));
  glBindVertexArray(0);
}

void GpuMesh::draw(DrawCount& count) const {
  if (count_ == 0) return;
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
  ++count.draws;
  count.triangles += count_ / 3;
}

GpuDrops::~GpuDrops() {
  if (array_ == 0) return;
  glDeleteVertexArrays(1, &array_);
  glDeleteBuffers(1, &vertices_);
}

void GpuDrops::put(std::span<const GpuDrop> drops) {
  if (array_ == 0) {
    glGenVertexArrays(1, &array_);
    glGenBuffers(1, &vertices_);
  }
  glBindVertexArray(array_);
  upload(GL_ARRAY_BUFFER, vertices_, drops);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(GpuDrop),
                        place(offsetof(GpuDrop, at_mm)));  // and size_mm behind it
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(GpuDrop),
                        place(offsetof(GpuDrop, colour)));
  glBindVertexArray(0);
  count_ = static_cast<int>(drops.size());
}

void GpuDrops::draw(DrawCount& count) const {
  if (count_ == 0) return;
  glEnable(GL_PROGRAM_POINT_SIZE);
  glBindVertexArray(array_);
  glDrawArrays(GL_POINTS, 0, count_);
  glBindVertexArray(0);
  glDisable(GL_PROGRAM_POINT_SIZE);
  ++count.draws;
}

Table2D::~Table2D() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
}
Table2D::Table2D(Table2D&& other) noexcept : texture_(std::exchange(other.texture_, 0)) {}
Table2D& Table2D::operator=(Table2D&& other) noexcept {
  std::swap(texture_, other.texture_);
  return *this;
}

namespace {

void sample_linearly(unsigned wrap) {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, static_cast<int>(wrap));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, static_cast<int>(wrap));
}

}  // namespace

void Table2D::put(int width, int height, int channels, std::span<const float> values) {
  if (texture_ == 0) glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, channels == 1 ? GL_R32F : GL_RGB16F, width, height, 0,
               channels == 1 ? GL_RED : GL_RGB, GL_FLOAT, values.data());
  sample_linearly(GL_CLAMP_TO_EDGE);
}

DepthMap::~DepthMap() { free(); }

void DepthMap::free() noexcept {
  if (frame_ == 0) return;
  glDeleteFramebuffers(1, &frame_);
  glDeleteTextures(1, &texture_);
  frame_ = 0;
}

bool DepthMap::resize(int edge) {
  if (frame_ != 0 && edge == edge_) return false;
  free();
  edge_ = edge;
  glGenFramebuffers(1, &frame_);
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, edge, edge, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  sample_linearly(GL_CLAMP_TO_BORDER);
  constexpr std::array<float, 4> k_lit{1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, k_lit.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  const bool whole = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (!whole)
    throw Error(msg("window"), msg("the graphics driver has no room for a shadow"),
                msg("update the driver"));
  return true;
}

void DepthMap::begin() const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, edge_, edge_);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void DepthMap::begin_with(const DepthMap& other) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, other.frame_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, frame_);
  glBlitFramebuffer(0, 0, edge_, edge_, 0, 0, edge_, edge_, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, edge_, edge_);
}

void DepthMap::end() { glBindFramebuffer(GL_FRAMEBUFFER, 0); }

const char* const WholePicture::vertex_shader = R"(
out vec2 over_all;
void main() {
  over_all = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  gl_Position = vec4(2.0 * over_all - 1.0, 0.0, 1.0);
})";

WholePicture::~WholePicture() {
  if (array_ != 0) glDeleteVertexArrays(1, &array_);
}

void WholePicture::draw(DrawCount& count) {
  if (array_ == 0) glGenVertexArrays(1, &array_);
  glBindVertexArray(array_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  ++count.draws;
  ++count.triangles;
}

RenderTarget::~RenderTarget() { free(); }

void RenderTarget::free() noexcept {
  if (frame_ == 0) return;
  glDeleteFramebuffers(1, &frame_);
  if (shown_frame_ != 0) glDeleteFramebuffers(1, &shown_frame_);
  if (colour_ != 0) glDeleteRenderbuffers(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  glDeleteTextures(1, &shown_);
  frame_ = shown_frame_ = colour_ = 0;
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
  glGenRenderbuffers(1, &depth_);
  glGenTextures(1, &shown_);
  glBindTexture(GL_TEXTURE_2D, shown_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  sample_linearly(GL_CLAMP_TO_EDGE);
  const int each = samples > 1 ? samples : 0;
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, each, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  if (samples > 1) {
    glGenRenderbuffers(1, &colour_);
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, each, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    glGenFramebuffers(1, &shown_frame_);
    glBindFramebuffer(GL_FRAMEBUFFER, shown_frame_);
  }
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, shown_, 0);
  bool whole = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  whole = whole && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (!whole)
    throw Error(msg("window"), msg("the graphics driver has no room for a picture of this size"),
                msg("make the window smaller"));
}

void RenderTarget::begin(const glm::vec3& background) const {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width_, height_);
  glClearColor(background.x, background.y, background.z, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void RenderTarget::end() const {
  if (shown_frame_ != 0) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, shown_frame_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace cavum::station
