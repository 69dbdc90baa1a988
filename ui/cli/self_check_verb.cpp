#include "ui/cli/self_check_verb.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/session/session.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#include "ui/parts/self_check.h"

namespace cavum::ui {
namespace {

/// Without the signature and what it is chained with: those stand in the station's file.
nlohmann::json entry_json(const CheckEntry& e) {
  nlohmann::json j = to_signed_json(e, load_station_key(station_key_path()));
  j.erase("signature");
  j.erase("previous");
  j["utc"] = utc_text(e.utc_ns);
  if (e.kind == CheckEntry::Kind::check) j["words"] = in_words(e.verdict);
  return j;
}

Lines figures_text(const ArmFigures& f) {
  Lines out;
  const std::array<const char*, 3> names{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const ArmAxis& a = f.axes[i];
    out.add(msg("{}: friction {}, moved mass {} kg (± {}), weight {}", names[i],
                as_n(a.friction_n, 3, 2.0 * a.friction_error_n), as_number(a.mass_kg, 4),
                as_percent(200.0 * a.mass_error, 1), as_n(a.weight_n)),
            2);
  }
  const auto ms = [](double v, int digits) { return as_unit(v, Unit::ms, digits); };
  out.add(msg("step {}; {} readings a second; ticks of {}, 99 % below {}, longest {}, missed {}",
              as_mm(f.quantum_mm, 4), as_number(f.rate_hz, 0), ms(f.tick_mean_ms, 3),
              ms(f.tick_p99_ms, 2), ms(f.tick_worst_ms, 1), as_percent(100.0 * f.ticks_missed, 2)),
          2);
  return out;
}

int show_history(const SelfCheckArguments& o) {
  const CheckHistory history(check_history_path());
  nlohmann::json all = nlohmann::json::array();
  for (const CheckEntry& e : history.entries()) {
    if (!o.stylus.empty() && e.stylus.id != o.stylus) continue;
    if (o.json) {
      all.push_back(entry_json(e));
      continue;
    }
    const std::string when = utc_text(e.utc_ns);
    if (e.kind == CheckEntry::Kind::check)
      say(msg("{}  {}  {}: {}", when, e.stylus.id, word_of(e.verdict.outcome),
              in_words(e.verdict)));
    else if (e.kind == CheckEntry::Kind::decision)
      say(e.go_on ? msg("{}  {}  decided to go on ({}): {}", when, e.stylus.id, e.by, e.reason)
                  : msg("{}  {}  decided to stop ({}): {}", when, e.stylus.id, e.by, e.reason));
    else
      say(msg("{}  {}  new history: {}", when, e.stylus.id, e.reason));
  }
  if (o.json) print_json(nlohmann::json{{"entries", all}});
  return 0;
}

}  // namespace

int self_check(const SelfCheckArguments& o) {
  if (o.history) return show_history(o);
  if (o.stylus.empty())
    throw Error(Name{"--self-check"}, msg("names no stylus"), msg("add --stylus"));
  if (!o.go_on.empty()) {
    const auto stylus = open_stylus(o.stylus);
    const CheckedStylus checked{stylus->facts().id, stylus->facts().serial};
    const auto last = CheckHistory(check_history_path()).last_check(checked);
    if (!last)
      throw Error(Name{"--override-check"}, msg("there is no check of this stylus to decide on"),
                  msg("run `cavum devices --self-check --stylus {}` first", o.stylus));
    decide_on_check(checked, true, "person", o.go_on);
    say(msg("kept: exams go on with it"));
    return 0;
  }
  const Interrupt interrupt;
  SelfCheckOptions options;
  options.new_history = o.new_history;
  options.stop = [] { return Interrupt::asked(); };
  Message told;
  if (!o.json)
    options.tell = [&told](const ArmProgress& p) {
      const Message now = msg("{}", p.words);
      if (now == told) return;
      say(told = now);
      std::cout << std::flush;
    };
  const SelfChecked done = check_station_stylus(o.stylus, options);
  const CheckVerdict& v = done.entry.verdict;
  if (o.json) {
    print_json(entry_json(done.entry));
  } else {
    say(msg("{}, {}: {}", done.entry.station, done.name, word_of(v.outcome)));
    if (done.entry.figures.doubt.empty()) say(figures_text(done.entry.figures));
    say(msg("{}", in_words(v)), 2);
    if (v.outcome == CheckOutcome::changed) {
      say(msg("since {}", utc_text(done.entry.since_utc_ns)), 2);
      say(msg("check again; if it stays: repair it, then --new-history REASON; or let exams go on with it: --override-check REASON"),
          2);
    }
  }
  return v.outcome == CheckOutcome::learning || v.outcome == CheckOutcome::unchanged ? 0 : 1;
}

}  // namespace cavum::ui
