// The few things of OpenGL that the station draws with: shader programs, triangle meshes, and
// pictures to draw into. Each owns what it made and gives it back; all belong to the window's
// thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>

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
[[nodiscard]] GpuVertex gpu_vertex(const glm::vec3& at_mm, const glm::vec3& normal,
                                   const std::array<std::uint8_t, 4>& colour);

/// A corner of the tooth's surface, 24 bytes.
struct ToothVertex {
  std::array<float, 3> at_mm{};
  std::array<std::int16_t, 3> normal{};  ///< in 1/32767
  std::uint8_t open = 255;               ///< how much of the light around reaches it, of 255
  std::uint8_t dentin_below = 0;         ///< share of dentin a millimetre below it, of 255
  std::array<std::uint8_t, 4> tissue{};  ///< the two tissues it is of, the second one's share of
                                         ///< 255; share of pulp beside it, of 255
  friend bool operator==(const ToothVertex&, const ToothVertex&) = default;
};

/// Something round and small in the air: place in mm, width in mm, colour and opacity 0..255.
struct GpuDrop {
  std::array<float, 3> at_mm{};
  float size_mm = 0.0F;
  std::array<std::uint8_t, 4> colour{};
};

/// What a picture took.
struct DrawCount {
  int draws = 0, triangles = 0;
};

class ShaderProgram {
 public:
  /// `defines`: names set before both sources, "A B=2". Throws Error with the compiler's words.
  ShaderProgram(const std::string& vertex, const std::string& fragment,
                const std::string& defines = "");
  ~ShaderProgram();
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;
  void use() const;
  void set(const char* name, const glm::mat4& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, const glm::mat3& value) const;
  void set(const char* name, const glm::vec2& value) const;
  void set(const char* name, const glm::vec4& value) const;
  void set(const char* name, float value) const;
  /// The texture of a sampler: `texture` of `kind` (of OpenGL) on this unit.
  void set_texture(const char* name, int unit, unsigned kind, unsigned texture) const;
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
  void put(std::span<const ToothVertex> vertices, std::span<const std::uint32_t> indices);
  void draw(DrawCount& count) const;
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] int triangles() const noexcept { return count_ / 3; }

 private:
  void bind();

  unsigned array_ = 0, vertices_ = 0, indices_ = 0;
  int count_ = 0;
};

/// Drops on the graphics card, all in one draw.
class GpuDrops {
 public:
  GpuDrops() = default;
  ~GpuDrops();
  GpuDrops(const GpuDrops&) = delete;
  GpuDrops& operator=(const GpuDrops&) = delete;
  void put(std::span<const GpuDrop> drops);
  void draw(DrawCount& count) const;

 private:
  unsigned array_ = 0, vertices_ = 0;
  int count_ = 0;
};

/// Numbers to be looked up between 0 and 1 across, linear between them, the outermost beyond.
class Table2D {
 public:
  Table2D() = default;
  ~Table2D();
  Table2D(Table2D&& other) noexcept;
  Table2D& operator=(Table2D&& other) noexcept;
  /// One number (`channels` 1) or three an entry, row by row.
  void put(int width, int height, int channels, std::span<const float> values);
  [[nodiscard]] unsigned texture() const noexcept { return texture_; }

 private:
  unsigned texture_ = 0;
};

/// Depths as a lamp sees them, to be compared with.
class DepthMap {
 public:
  DepthMap() = default;
  ~DepthMap();
  DepthMap(const DepthMap&) = delete;
  DepthMap& operator=(const DepthMap&) = delete;
  /// Returns whether it had to be made anew; then it holds nothing.
  bool resize(int edge);
  void begin() const;  ///< empty, and drawn into
  /// What another of the same size holds, and drawn into.
  void begin_with(const DepthMap& other) const;
  static void end();
  [[nodiscard]] unsigned texture() const noexcept { return texture_; }
  [[nodiscard]] int edge() const noexcept { return edge_; }

 private:
  void free() noexcept;
  int edge_ = 0;
  unsigned frame_ = 0, texture_ = 0;
};

/// A pass over the whole picture: a vertex shader `over_all` and three corners.
class WholePicture {
 public:
  WholePicture() = default;
  ~WholePicture();
  WholePicture(const WholePicture&) = delete;
  WholePicture& operator=(const WholePicture&) = delete;
  void draw(DrawCount& count);
  static const char* const vertex_shader;

 private:
  unsigned array_ = 0;
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
  [[nodiscard]] int samples() const noexcept { return samples_; }
  [[nodiscard]] unsigned texture() const noexcept { return shown_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

 private:
  void free() noexcept;
  int width_ = 0, height_ = 0, samples_ = 0;
  unsigned frame_ = 0, colour_ = 0, depth_ = 0, shown_frame_ = 0, shown_ = 0;
};

}  // namespace cavum::station
