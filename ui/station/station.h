// The station: one window, in which candidates sign in, are checked, briefed, examined and told
// their result, one after the other. The window's thread shows and asks; the exam itself runs in
// the servo's and the recorder's threads, whatever becomes of the window.
#pragma once

#include <optional>
#include <string>

#include "ui/office/station_link.h"
#include "ui/station/sitting.h"

namespace cavum::station {

struct StationOptions {
  SittingOptions sitting;
  std::string candidate;         ///< code that stands in the field at sign-in; may be empty
  std::string replay;            ///< a session to look at, instead of sitting an exam
  std::string script, pictures;  ///< a file of keys, and where its pictures go; may be empty
  int width = 1280, height = 800;
  std::string supervisor_hash;  ///< of the code that leaves a locked station (supervisor_code.h);
                                ///< empty: it is not locked
  bool tutorial = false;        ///< the first steps, in practice
  std::string monitor;          ///< number from 1 or name; empty: where the desktop puts the window
  double text_scale = 1.0;
  bool left_handed = false, high_contrast = false;
  std::optional<double> self_check_hours;  ///< a check of the stylus that is older is made anew
                                           ///< before an exam; empty: none is made
  std::optional<office::LinkOptions>
      office;  ///< the exam office that the station speaks with by itself
  std::optional<std::size_t>
      effects;  ///< of the picture, 0 (richest) to 5; else as the computer keeps up with
};

/// Opens the window and returns when it is closed: 0, or 1 when an exam is left open, which a line
/// on standard error names. Throws Error when there is no display, the scenario is wrong, or the
/// window fails; a running session can be resumed then.
[[nodiscard]] int run_station(const StationOptions& options);

/// For a bench: draws the tooth of a scenario so many times, each from another side, and prints how
/// long a picture takes.
void print_frame_times(const StationOptions& options, int frames);

}  // namespace cavum::station
