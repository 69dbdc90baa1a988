// The few things of OpenGL that the station draws with: shader programs, triangle meshes, and pictures to draw into. Each owns what it made and
// gives it back; all belong to the window's thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "engine/tooth/surface_patches.h"

namespace cavum::station {

/// Who draws, in the words of the current context; empty when it does not say.
[[nodiscard]] std::string renderer_name();
/// True when that is a program on the computer's processor instead of a graphics card.
[[nodiscard]] bool drawn_by_processor();

/// A corner of a triangle: place in mm, normal in 1/127, colour and opacity 0..255.
struct GpuVertex {
  std::array<float, 3> at_mm{};
  std::array<std::int8_t, 4> normal{};
  std::array<std::uint8_t, 4> colour{};
};
[[nodiscard]] GpuVertex gpu_vertex(const glm::vec3& at_mm, const glm::vec3& normal, const std::array<std::uint8_t, 4>& colour);

class ShaderProgram {
 public:
  /// Throws Error with the compiler's words.
  ShaderProgram(const char* vertex, const char* fragment);
  ~ShaderProgram();
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;
  void use() const;
  void set(const char* name, const glm::mat4& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, float value) const;
  void set(const char* name, std::span<const glm::vec3> values) const;

 private:
  unsigned program_ = 0;
};

/// Triangles on the graphics card.
class GpuMesh {
 public:
  GpuMesh() = default;
  ~GpuMesh();
  GpuMesh(GpuMesh&& other) noexcept;
  GpuMesh& operator=(GpuMesh&& other) noexcept;
  void put(std::span<const GpuVertex> vertices, std::span<const std::uint32_t> indices);
  /// The same of a tooth's surface; nothing is drawn of an empty one.
  void put(const SurfacePatch& patch);
  void draw() const;
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] int triangles() const noexcept { return count_ / 3; }

 private:
  void bind();

  unsigned array_ = 0, vertices_ = 0, indices_ = 0;
  unsigned index_type_ = 0;  // of OpenGL
  int count_ = 0;
};

/// A picture with depth that can be drawn into and then shown.
class RenderTarget {
 public:
  RenderTarget() = default;
  ~RenderTarget();
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;
  /// Makes it this large, if it is not; `samples` a pixel smooth the edges, 1 = none.
  void resize(int width, int height, int samples);
  void begin(const glm::vec3& background) const;
  void end() const;  ///< after it `texture` holds what was drawn
  [[nodiscard]] unsigned texture() const noexcept { return shown_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

 private:
  void free() noexcept;
  int width_ = 0, height_ = 0, samples_ = 0;
  unsigned frame_ = 0, colour_ = 0, depth_ = 0, shown_frame_ = 0, shown_ = 0;
};

}  // namespace cavum::station
