// What keyboard and mouse did, in its order and with its times. A picture shows the world after
// what came in until it began; a key that went down and up between two pictures is down in one of
// them and up in the next, so that nothing is lost at any rate of pictures. What is moved by a held
// key goes by how long it was held, not by how many pictures saw it.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace cavum::station {

struct InputEvent {
  enum class Kind : std::uint8_t { key, button, text, wheel, motion, focus, screens };
  Kind kind = Kind::key;
  int code =
      0;  ///< key of GLFW, button from 0, or letter (Unicode); of `screens` how many there are
  bool down = false;                 ///< pressed; of `focus` whether it was won
  double t_s = 0.0;                  ///< of one clock, never running back
  float x = 0.0F, y = 0.0F;          ///< of `motion` the way, of `wheel` the turns
  bool ctrl = false, shift = false;  ///< held then; set by `play`
};

/// How long a key has been held: at the end of the picture before, and now. A key that was let go
/// of in this picture still counts up to then.
struct KeyHold {
  bool pressed = false;  ///< in this picture
  double from_s = 0.0, to_s = 0.0;
};

/// How far a held key has moved something: a step at once, and after a short wait evenly on. A tap
/// is one step, however short.
struct HeldKeyLaw {
  double step = 0.0, per_s = 0.0, wait_s = 0.2;
  [[nodiscard]] double travel(const KeyHold& hold) const noexcept;
};

class InputQueue {
 public:
  static constexpr double k_longest_picture_s =
      0.25;  ///< of a longer one, only so much counts as held: the handpiece stands by then

  /// In the order in which they came. What is no change (pressed while down) is ignored.
  void push(const InputEvent& event);
  /// A key, with the modifiers that the system says are held (GLFW_MOD_*): whoever took one's
  /// release for himself, as a window manager does with Alt+F4, took it from all others, and it
  /// would be held for ever.
  void push_key(const InputEvent& event, int modifiers);
  /// Plays them up to `now_s`, or up to the first that would change a key a second time: it and all
  /// after it wait for the next picture.
  const std::vector<InputEvent>& play(double now_s);
  [[nodiscard]] const std::vector<InputEvent>& played() const noexcept { return played_; }
  /// After what was played.
  [[nodiscard]] bool down(int key) const noexcept { return known(key) && keys_[index(key)].down; }
  [[nodiscard]] bool button_down(int button) const noexcept {
    return button >= 0 && button < k_buttons && buttons_[index(button)].down;
  }
  [[nodiscard]] KeyHold hold(int key) const noexcept {
    return known(key) ? keys_[index(key)].hold : KeyHold{};
  }
  [[nodiscard]] bool waiting() const noexcept { return !waiting_.empty(); }

 private:
  static constexpr int k_keys = 512, k_buttons = 8;
  struct Key {
    bool down = false, changed = false;
    double since_s = 0.0;
    KeyHold hold;
  };
  [[nodiscard]] static bool known(int key) noexcept { return key >= 0 && key < k_keys; }
  [[nodiscard]] static std::size_t index(int code) noexcept {
    return static_cast<std::size_t>(code);
  }
  /// The key or button that an event changes; null when it changes none.
  [[nodiscard]] Key* changed_by(const InputEvent& event) noexcept;

  std::deque<InputEvent> waiting_;
  std::vector<InputEvent> played_;
  std::array<Key, k_keys> keys_{};
  std::array<Key, k_buttons> buttons_{};
  double until_s_ = 0.0;
};

}  // namespace cavum::station
