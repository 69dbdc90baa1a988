#include "ui/verbs/self_check_verb.h"

#include <fmt/core.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/session/session.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/print_json.h"
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

std::string figures_text(const ArmFigures& f) {
  std::string text;
  const char* const names = "xyz";
  for (std::size_t i = 0; i < 3; ++i) {
    const ArmAxis& a = f.axes[i];
    text += fmt::format("  {}  friction {:.3f} N (± {:.3f}), moved mass {:.4f} kg (± {:.1f} %), weight {:.2f} N\n", names[i], a.friction_n,
                        2.0 * a.friction_error_n, a.mass_kg, 200.0 * a.mass_error, a.weight_n);
  }
  text += fmt::format("  step {:.4f} mm; {:.0f} readings a second; ticks of {:.3f} ms, 99 % below {:.2f}, longest {:.1f}, missed {:.2f} %\n",
                      f.quantum_mm, f.rate_hz, f.tick_mean_ms, f.tick_p99_ms, f.tick_worst_ms, 100.0 * f.ticks_missed);
  return text;
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
    std::cout << utc_text(e.utc_ns) << "  " << one_line(e.stylus.id) << "  ";
    if (e.kind == CheckEntry::Kind::check)
      std::cout << outcome_name(e.verdict.outcome) << ": " << one_line(in_words(e.verdict)) << "\n";
    else if (e.kind == CheckEntry::Kind::decision)
      std::cout << "decided to " << (e.go_on ? "go on" : "stop") << " (" << one_line(e.by) << "): " << one_line(e.reason) << "\n";
    else
      std::cout << "new history: " << one_line(e.reason) << "\n";
  }
  if (o.json) print_json(nlohmann::json{{"entries", all}});
  return 0;
}

}  // namespace

int self_check(const SelfCheckArguments& o) {
  if (o.history) return show_history(o);
  if (o.stylus.empty()) throw Error("--self-check", msg("names no stylus"), msg("add --stylus"));
  if (!o.go_on.empty()) {
    const auto stylus = open_stylus(o.stylus);
    const CheckedStylus checked{stylus->facts().id, stylus->facts().serial};
    const auto last = CheckHistory(check_history_path()).last_check(checked);
    if (!last)
      throw Error("--go-on", msg("there is no check of this stylus to decide on"),
                  msg("run `cavum devices --self-check --stylus {}` first", o.stylus));
    decide_on_check(checked, true, "person", o.go_on);
    std::cout << "kept: exams go on with it\n";
    return 0;
  }
  const Interrupt interrupt;
  SelfCheckOptions options;
  options.new_history = o.new_history;
  options.stop = [] { return Interrupt::asked(); };
  std::string said;
  if (!o.json)
    options.tell = [&said](const ArmProgress& p) {
      if (p.words != said) std::cout << (said = p.words) << "\n" << std::flush;
    };
  const SelfChecked done = check_station_stylus(o.stylus, options);
  const CheckVerdict& v = done.entry.verdict;
  if (o.json) {
    print_json(entry_json(done.entry));
  } else {
    std::cout << one_line(done.entry.station) << ", " << one_line(done.name) << ": " << outcome_name(v.outcome) << "\n";
    if (done.entry.figures.doubt.empty()) std::cout << figures_text(done.entry.figures);
    std::cout << "  " << one_line(in_words(v)) << "\n";
    if (v.outcome == CheckOutcome::changed)
      std::cout << "  since " << utc_text(done.entry.since_utc_ns)
                << "\n  check again; if it stays: repair it, then --new-history REASON; or let exams go on with it: --go-on REASON\n";
  }
  return v.outcome == CheckOutcome::learning || v.outcome == CheckOutcome::unchanged ? 0 : 1;
}

}  // namespace cavum::ui
