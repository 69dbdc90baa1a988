#include "engine/device/motion_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr std::array<std::string_view, 12> k_columns{"t_s", "x_mm", "y_mm",  "z_mm", "qw", "qx",
                                                     "qy",  "qz",   "pedal", "b1",   "b2", "bur"};
constexpr std::size_t k_required = 9;

constexpr double k_longest_s = 86'400;  // a day
constexpr double k_latest_s =
    1e10;  // a clock in seconds since 1970 reaches it in 2286; one in milliseconds is far beyond

constexpr CsvForm k_motion{.most_rows = 200'000'000,  // a day of ticks at 2 kHz
                           .quotes = false,
                           .plain_text = false};

/// Which of our columns each cell of the header is.
std::vector<std::size_t> read_header(const CsvReader& in) {
  std::vector<std::size_t> column_of;
  for (const auto name : in.fields()) {
    const auto found = std::find(k_columns.begin(), k_columns.end(), name);
    if (found == k_columns.end()) {
      for (const std::string_view axis : {"t", "x", "y", "z"})
        if (name == axis || name.starts_with(fmt::format("{}_", axis)))
          in.fail(MotionError::column_unit,
                  msg("column '{}' has another unit or none", one_line(name)),
                  msg("convert it to '{}'", fmt::format("{}{}", axis, axis == "t" ? "_s" : "_mm")));
      in.fail(MotionError::unknown_column, msg("column '{}' is not known", one_line(name)),
              msg("use t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal and optionally b1,b2,bur"));
    }
    const auto c = static_cast<std::size_t>(found - k_columns.begin());
    if (std::find(column_of.begin(), column_of.end(), c) != column_of.end())
      in.fail(MotionError::column_twice, msg("column '{}' stands twice", name), msg("remove one"));
    column_of.push_back(c);
  }
  for (std::size_t c = 0; c < k_required; ++c)
    if (std::find(column_of.begin(), column_of.end(), c) == column_of.end())
      in.fail(MotionError::column_missing, msg("column '{}' is missing", k_columns[c]),
              msg("add it to header and rows"));
  return column_of;
}

MotionSample read_row(const CsvReader& in, const std::vector<std::size_t>& column_of) {
  const auto& cells = in.fields();
  std::array<double, k_columns.size()> v{};
  v[11] = -1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double& value = v[column_of[i]];
    const auto name = std::string(k_columns[column_of[i]]);
    const auto [end, error] =
        std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), value);
    if (error != std::errc{} || end != cells[i].data() + cells[i].size())
      in.fail(MotionError::not_a_number, msg("'{}' in column {} is not a number", cells[i], name),
              msg("write a number with a point"));
    if (!std::isfinite(value))
      in.fail(MotionError::not_finite, msg("column {} is {}", name, cells[i]),
              msg("repair or cut out this row"));
  }
  if (v[0] < 0)
    in.fail(MotionError::time, msg("t_s is {}, before the start of time", as_number(v[0])),
            msg("shift all times so that the first row is at 0 s"));
  if (v[0] > k_latest_s)
    in.fail(MotionError::time, msg("t_s is {}, which cannot be seconds", as_number(v[0])),
            msg("convert it to seconds, the first row at 0 s"));
  if (v[8] < 0 || v[8] > 1)
    in.fail(MotionError::pedal, msg("pedal is {}, outside 0 .. 1", as_number(v[8])),
            msg("scale it: 0 released, 1 pressed to the floor"));
  for (int axis = 1; axis <= 3; ++axis)
    if (std::fabs(v[static_cast<std::size_t>(axis)]) > 500)
      in.fail(MotionError::too_far,
              msg("{} is further than 500 mm from the tooth",
                  k_columns[static_cast<std::size_t>(axis)]),
              msg("give millimetres in the tooth frame"));
  const double n2 = v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7];
  if (n2 < 0.5 || n2 > 2)
    in.fail(MotionError::rotation, msg("the rotation qw,qx,qy,qz is not of unit length"),
            msg("give a unit quaternion, 1,0,0,0 for an upright handpiece"));
  const bool has_bur =
      std::find(column_of.begin(), column_of.end(), std::size_t{11}) != column_of.end();
  if (has_bur && (v[11] != std::floor(v[11]) || v[11] < 0 || v[11] > 255))
    in.fail(MotionError::bur, msg("bur is {}, not a number of the tray", as_number(v[11])),
            msg("write 0 for the first bur"));
  for (const std::size_t button : {9u, 10u})
    if (v[button] != 0 && v[button] != 1)
      in.fail(MotionError::button,
              msg("{} is {}, neither 0 nor 1", k_columns[button], as_number(v[button])),
              msg("write 1 while the button is pressed, else 0"));
  return {v[0],       {{v[1], v[2], v[3]}, normalized(Quat{v[4], v[5], v[6], v[7]})},
          v[8],       v[9] != 0,
          v[10] != 0, static_cast<int>(v[11])};
}

constexpr double k_coarsest_mm = 1.0, k_furthest_mm = 500.0;

/// What a comment `# NAME = VALUE` says: the bur, or the encoder's step.
void take_setting(const CsvReader& in, Motion& motion) {
  const auto equals = in.comment().find('=');
  if (equals == std::string_view::npos) return;
  const auto name = without_blanks(in.comment().substr(0, equals)),
             value = without_blanks(in.comment().substr(equals + 1));
  if (name == "bur") {
    motion.bur = value;
    if (motion.bur.empty())
      in.fail(MotionError::setting, msg("'# bur =' names no bur"),
              msg("write its name, such as round-1.0, or leave the line out"));
  } else if (name == "position_quantum_mm") {
    double& q = motion.position_quantum_mm;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), q);
    if (error != std::errc{} || end != value.data() + value.size() ||
        !(q >= 0 && q <= k_coarsest_mm))
      in.fail(MotionError::setting,
              msg("'# position_quantum_mm = {}' is no step of an encoder", one_line(value)),
              msg("write millimetres from 0 to 1, such as 0.055"));
  } else if (name == "first_tip_mm") {
    Vec3 tip;
    const auto refuse = [&] {
      in.fail(MotionError::setting, msg("'# first_tip_mm = {}' is no place", one_line(value)),
              msg("write three numbers in mm, such as 1.5 0 2"));
    };
    const char *at = value.data(), *const end = value.data() + value.size();
    for (double* axis : {&tip.x, &tip.y, &tip.z}) {
      while (at < end && *at == ' ') ++at;
      const auto [next, error] = std::from_chars(at, end, *axis);
      if (error != std::errc{} || !(std::fabs(*axis) <= k_furthest_mm)) refuse();
      at = next;
    }
    if (at != end) refuse();
    motion.first_tip_mm = tip;
  }
}

/// Throws Error unless the sample is later than those before it, and within a day of the first.
void add(Motion& motion, const MotionSample& sample, const CsvReader& in) {
  if (!motion.samples.empty() && !(sample.t_s > motion.samples.back().t_s))
    in.fail(MotionError::time_order, msg("t_s does not grow"),
            msg("sort the rows and remove repeated times"));
  motion.samples.push_back(sample);
  if (motion.duration_s() > k_longest_s)
    in.fail(MotionError::too_long,
            msg("t_s is {} after the first row, more than a day",
                as_s(motion.duration_s(), k_as_needed)),
            msg("give seconds, and cut the file where the work ends"));
}

/// Throws Error for a motion so small that its positions must be metres.
void require_millimetres(const Motion& motion, const std::string& where) {
  Bounds box;
  for (const auto& s : motion.samples) box.add(s.pose.tip_mm);
  const double way = length(box.high - box.low);
  if (way > 0 && way < 0.05)
    throw Error(MotionError::in_metres, Name{where}, msg("moves less than 0.05 mm in all"),
                msg("x_mm, y_mm and z_mm look like metres: multiply by 1000"));
}

}  // namespace

Motion parse_motion(const std::string& text, const std::string& where) {
  if (text.find('\0') != std::string::npos)
    throw Error(MotionError::not_text, Name{where}, msg("is no text: it holds zero bytes"),
                msg("give a motion as CSV, in UTF-8"));
  CsvReader in(text, where, k_motion);
  Motion motion;
  std::vector<std::size_t> column_of;
  for (CsvReader::Line line; (line = in.next()) != CsvReader::Line::end;) {
    if (line == CsvReader::Line::comment)
      take_setting(in, motion);
    else if (column_of.empty())
      column_of = read_header(in);
    else
      add(motion, read_row(in, column_of), in);
  }
  if (motion.samples.size() < 2)
    throw Error(MotionError::too_short, Name{where}, msg("holds fewer than two rows of motion"),
                msg("give a header and at least two rows"));
  require_millimetres(motion, where);
  return motion;
}

double motion_quantum_mm(const std::string& text, const std::string& where) {
  CsvReader in(text, where, k_motion);
  Motion motion;
  for (CsvReader::Line line; (line = in.next()) == CsvReader::Line::comment;)
    take_setting(in, motion);
  return motion.position_quantum_mm;
}

namespace {

constexpr double k_turn_one = 1 << 30;

/// A rotation that is read back as these whole numbers. They are rounded, so that their length is
/// not 1 to the last digit; normalising moves them a little.
std::optional<Quat> read_back_as(const TickInput& want) {
  const auto& r = want.rotation_q30;
  const auto gives = [&](const Quat& q) {
    const Quat once = normalized(q);  // as read_row does, and Motion::at
    return make_tick_input({want.tip_mm(), normalized(once)}, 0.0, k_stylus_fresh, 0, {})
               .rotation_q30 == r;
  };
  for (int step = 0; step < 81; ++step) {
    const auto off = [&](int power) {
      return 0.3 * (((step / power) + 1) % 3 - 1);
    };  // none of any first
    const Quat q{(r[0] + off(1)) / k_turn_one, (r[1] + off(3)) / k_turn_one,
                 (r[2] + off(9)) / k_turn_one, (r[3] + off(27)) / k_turn_one};
    if (gives(q)) return q;
  }
  return std::nullopt;
}

}  // namespace

std::string motion_text(std::span<const TickInput> inputs, Vec3 first_tip_mm,
                        double position_quantum_mm, const std::string& where) {
  std::string out = fmt::format(
      "# position_quantum_mm = {}\n# first_tip_mm = {} {} {}\nt_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal,b1,b2,bur\n",
      position_quantum_mm, first_tip_mm.x, first_tip_mm.y, first_tip_mm.z);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const TickInput& in = inputs[i];
    if ((in.flags & (k_stylus_fresh | k_pedal_fresh)) != (k_stylus_fresh | k_pedal_fresh) ||
        (in.flags & k_stylus_fault) != 0)
      throw Error(MotionError::no_reading, Name{where},
                  msg("tick {}: stylus or pedal gave nothing, which no motion file can say", i),
                  msg("replay the session itself: `cavum replay`"));
    const std::optional<Quat> q = read_back_as(in);
    if (!q)
      throw Error(MotionError::rotation, Name{where},
                  msg("tick {}: its rotation is none of unit length", i),
                  msg("replay the session itself: `cavum replay`"));
    const auto mm = [](std::int32_t nm) {
      return fmt::format("{}{}.{:06}", nm < 0 ? "-" : "", std::abs(nm) / 1'000'000,
                         std::abs(nm) % 1'000'000);
    };
    out += fmt::format("{}.{:03},{},{},{},{},{},{},{},{},{},{},{}\n", i / 1000, i % 1000,
                       mm(in.tip_nm[0]), mm(in.tip_nm[1]), mm(in.tip_nm[2]), q->w, q->x, q->y, q->z,
                       in.pedal(), (in.flags & k_button_1) != 0 ? 1 : 0,
                       (in.flags & k_button_2) != 0 ? 1 : 0, in.bur);
  }
  return out;
}

int line_of_sample(const std::string& text, std::size_t sample) {
  CsvReader in(text, "", k_motion);
  for (std::size_t row = 0; row <= sample + 1; ++row) in.next_row();  // the heading is row 0
  return in.line();
}

MotionSample Motion::at(double t_s) const noexcept {
  constexpr double k_same_s =
      1e-9;  // a sum of times may fall short of a sample's own by its last digit
  const double t = samples.front().t_s + t_s;
  const auto after =
      std::upper_bound(samples.begin(), samples.end(), t + k_same_s,
                       [](double time, const MotionSample& s) { return time < s.t_s; });
  if (after == samples.begin()) return samples.front();
  if (after == samples.end()) return samples.back();
  const MotionSample &a = *(after - 1), &b = *after;
  const double past = t - a.t_s, f = past > k_same_s ? past / (b.t_s - a.t_s) : 0.0;
  MotionSample s = a;  // pedal is linear, buttons and bur hold
  s.t_s = t;
  s.pose.tip_mm = a.pose.tip_mm + (b.pose.tip_mm - a.pose.tip_mm) * f;
  const Quat p = a.pose.rotation, q = b.pose.rotation;
  const double side =
      p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -1.0 : 1.0;  // the shorter way round
  s.pose.rotation = normalized(Quat{p.w + (side * q.w - p.w) * f, p.x + (side * q.x - p.x) * f,
                                    p.y + (side * q.y - p.y) * f, p.z + (side * q.z - p.z) * f});
  s.pedal = a.pedal + (b.pedal - a.pedal) * f;
  return s;
}

}  // namespace cavum
