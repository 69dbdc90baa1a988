#include "ui/station/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace cavum::station {

double HeldKeyLaw::travel(const KeyHold& hold) const noexcept {
  const auto going = [this](double held_s) { return per_s * std::max(0.0, held_s - wait_s); };
  return (hold.pressed ? step : 0.0) + going(hold.to_s) - going(hold.from_s);
}

void InputQueue::push(const InputEvent& event) { waiting_.push_back(event); }

void InputQueue::push_key(const InputEvent& event, int modifiers) {
  struct Modifier {
    int bit, left, right;
  };
  static constexpr std::array<Modifier, 4> k_modifiers{
      {{GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT},
       {GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL},
       {GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT},
       {GLFW_MOD_SUPER, GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER}}};
  const bool itself =
      event.code >= GLFW_KEY_LEFT_SHIFT &&
      event.code <= GLFW_KEY_RIGHT_SUPER;  // what is held then is said in different ways
  for (const Modifier& m : k_modifiers)
    if (!itself && (modifiers & m.bit) == 0)
      for (const int key : {m.left, m.right})
        push({.kind = InputEvent::Kind::key, .code = key, .t_s = event.t_s});
  push(event);
}

InputQueue::Key* InputQueue::changed_by(const InputEvent& event) noexcept {
  Key* key = nullptr;
  if (event.kind == InputEvent::Kind::key && known(event.code)) key = &keys_[index(event.code)];
  if (event.kind == InputEvent::Kind::button && event.code >= 0 && event.code < k_buttons)
    key = &buttons_[index(event.code)];
  return key != nullptr && key->down != event.down ? key : nullptr;
}

const std::vector<InputEvent>& InputQueue::play(double now_s) {
  played_.clear();
  const auto begin = [](Key& key) {
    key.changed = false;
    key.hold = {false, key.down ? key.hold.to_s : 0.0, key.down ? key.hold.to_s : 0.0};
  };
  for (Key& key : keys_) begin(key);
  for (Key& key : buttons_) begin(key);
  double until_s = std::max(until_s_, now_s);
  for (; !waiting_.empty(); waiting_.pop_front()) {
    InputEvent event = waiting_.front();
    event.t_s = std::clamp(event.t_s, until_s_, std::max(until_s_, now_s));
    Key* key = changed_by(event);
    if (key != nullptr && key->changed) {
      until_s = event.t_s;
      break;
    }
    until_s_ = event.t_s;
    if (key == nullptr &&
        (event.kind == InputEvent::Kind::key || event.kind == InputEvent::Kind::button))
      continue;
    if (key != nullptr) {
      key->changed = true;
      key->down = event.down;
      if (event.down) {
        key->since_s = event.t_s;
        key->hold = {true, 0.0, 0.0};
      } else {
        key->hold.to_s = std::max(key->hold.from_s, event.t_s - key->since_s);
      }
    }
    event.ctrl = down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL);
    event.shift = down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT);
    played_.push_back(event);
  }
  until_s_ = until_s;
  const auto end = [until_s](Key& key) {
    if (key.down) key.hold.to_s = std::max(key.hold.to_s, until_s - key.since_s);
    key.hold.from_s = std::max(key.hold.from_s, key.hold.to_s - k_longest_picture_s);
  };
  for (Key& key : keys_) end(key);
  for (Key& key : buttons_) end(key);
  return played_;
}

}  // namespace cavum::station
