#include "grading/cohort/class_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"
#include "grading/cohort/judge_names.h"
#include "grading/records/exam_scale.h"
#include "grading/result/result_json.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::cohort {
namespace {

using grading::Verdict;
using nlohmann::json;

constexpr double k_far = 2.5;  // standard deviations from the class, or from the judges
constexpr int k_shuffles = 9999;

double max_in(const json& result) { return result.at("score").at("max").get<double>(); }

/// As the exam was sat; of an exam without any sealed result, as the first who counts was marked.
records::ExamScale scale_of(const records::Registry& registry, const std::string& exam,
                            const CountingSessions& sat) {
  const auto own = records::own_scales(registry);
  const auto at = own.find(exam);
  return at != own.end() ? at->second : records::scale_in(*sat.begin()->second->result);
}

/// On the scale of the class.
double points_in(const json& result, double max_points) {
  return result.at("score").at("points").get<double>() / max_in(result) * max_points;
}

/// 0 fail, 1 borderline, 2 pass.
std::size_t band_of(double points, double pass_points, double band) {
  return points < pass_points - band ? 0 : points > pass_points + band ? 2 : 1;
}

/// The marks that people gave to those who sat the exam.
struct GivenMarks {
  std::map<std::string, std::map<std::string, double>> by_candidate;  // points, by judge
  std::set<std::string> judges, rated_candidates;
  std::vector<double> ratings,
      rated;  // each rating, and the program's points of the same candidate
};

GivenMarks marks_given(ClassFigures& f, const CountingSessions& sat,
                       const std::vector<HumanMark>& marks) {
  GivenMarks given;
  for (const auto& m : marks) {
    const auto s = sat.find(m.candidate);
    if (s == sat.end()) {
      f.to_look_at.push_back(
          {0, m.candidate, msg("was marked by {}, and has no session of this exam", m.judge)});
      continue;
    }
    given.by_candidate[m.candidate][m.judge] = m.points;
    given.judges.insert(m.judge);
    if (m.rating) {
      given.ratings.push_back(*m.rating);
      given.rated_candidates.insert(m.candidate);
      given.rated.push_back(points_in(*s->second->result, f.max_points));
    }
  }
  return given;
}

/// Program and people beside each other, candidate by candidate.
struct MarkPairs {
  std::vector<double> program, people;  // the people's mean
  Matrix bands = Matrix(
      3, std::vector<double>(3));  // how often which band of the program met which of the people
  Matrix by_judge;                 // the program and each judge, of those whom all judges marked
  [[nodiscard]] std::size_t incomplete() const { return program.size() - by_judge.size(); }
};

MarkPairs pair_marks(const GivenMarks& given, const CountingSessions& sat, const ClassFigures& f,
                     double band) {
  MarkPairs pairs;
  for (const auto& [candidate, by_judge] : given.by_candidate) {
    const double own = points_in(*sat.at(candidate)->result, f.max_points);
    double sum = 0;
    for (const auto& [judge, points] : by_judge) sum += points;
    pairs.program.push_back(own);
    pairs.people.push_back(sum / static_cast<double>(by_judge.size()));
    if (f.pass_points)
      pairs.bands[band_of(own, *f.pass_points, band)]
                 [band_of(pairs.people.back(), *f.pass_points, band)] += 1;
    if (by_judge.size() < given.judges.size()) continue;
    std::vector<double> row = {own};
    for (const auto& [judge, points] : by_judge) row.push_back(points);
    pairs.by_judge.push_back(std::move(row));
  }
  return pairs;
}

/// `one_cut`: all were marked by one pass mark and band.
void put_agreement(Agreement& a, const GivenMarks& given, const MarkPairs& pairs, double borderline,
                   bool one_cut) {
  const auto when_possible = [](auto& out, const auto& make) {
    try {
      out = make();
    } catch (const Error&) {
      out.reset();  // too few, or all alike
    }
  };
  a.rated = given.rated_candidates.size();
  a.n = given.by_candidate.size();
  a.judges = given.judges.size();
  a.incomplete = pairs.incomplete();
  when_possible(a.icc, [&] { return intraclass_correlation(pairs.by_judge); });
  when_possible(a.limits, [&] { return limits_of_agreement(pairs.program, pairs.people); });
  if (one_cut)
    when_possible(a.kappa, [&] { return weighted_kappa(pairs.bands, quadratic_weights(3)); });
  const auto [least, most] = std::minmax_element(given.ratings.begin(), given.ratings.end());
  if (!given.ratings.empty() && borderline >= *least &&
      borderline <= *most)  // beyond the ratings given the line says nothing
    when_possible(a.cut, [&] { return borderline_cut(given.ratings, given.rated, borderline); });
}

/// Candidates whom program and people see further apart than the others.
void look_at_disagreements(ClassFigures& f, const CountingSessions& sat, const GivenMarks& given,
                           const MarkPairs& pairs) {
  const auto& limits = f.agreement.limits;
  if (!limits || limits->sd <= 0) return;
  std::size_t i = 0;
  for (const auto& [candidate, by_judge] : given.by_candidate) {
    const double program = pairs.program[i], off = program - pairs.people[i];
    ++i;
    if (std::fabs(off - limits->bias) > k_far * limits->sd)
      f.to_look_at.push_back({sat.at(candidate)->seq, candidate,
                              msg("people gave {} points, the program {}", as_points(program - off),
                                  as_points(program))});
  }
}

std::vector<WallFigures> walls_of(const CountingSessions& sat) {
  std::vector<WallFigures> out;
  for (std::size_t w = 0; w < scenarios::k_walls; ++w) {
    WallFigures f;
    f.wall = scenarios::wall_name(static_cast<scenarios::Wall>(w));
    for (const auto& [candidate, s] : sat) {
      const json wall = s->result->value("walls", json::object()).value(f.wall, json::object());
      if (!wall.value("mean_mm", json()).is_number() || !wall.value("p95_mm", json()).is_number())
        continue;
      ++f.n;
      f.mean_mm += wall["mean_mm"].get<double>();
      f.p95_mm += wall["p95_mm"].get<double>();
      f.worst_mm = std::max(f.worst_mm, wall.value("max_over_mm", 0.0));
    }
    if (f.n == 0) continue;
    f.mean_mm /= static_cast<double>(f.n);
    f.p95_mm /= static_cast<double>(f.n);
    out.push_back(f);
  }
  return out;
}

/// Of the sessions that count: what a person should see for himself, whatever the points say; and
/// those that do not count, with the reason.
void look_at_sessions(ClassFigures& f, const records::Registry& registry,
                      const CountingSessions& sat) {
  for (const auto& s : registry.sessions) {
    if (s.scenario_id != f.exam) continue;
    if (!s.findings.empty()) {
      const Message counts =
          s.chosen
              ? msg("was filed with findings, and counts, for a person chose it: {}",
                    s.findings.front().message())
              : msg("was filed with findings and does not count: {}", s.findings.front().message());
      f.to_look_at.push_back(
          {s.seq, s.candidate,
           s.findings.size() > 1 ? msg("{}, and {} more", counts, s.findings.size() - 1) : counts});
    }
    for (const auto other : s.contested_by)
      f.to_look_at.push_back(
          {s.seq, s.candidate,
           s.chosen
               ? msg("counts, for a person chose it: entry {} ends the same exam otherwise", other)
               : msg("does not count: entry {} ends the same exam otherwise", other)});
  }
  if (f.simulated > 0 && f.simulated < f.n)
    f.to_look_at.push_back(
        {0, "",
         msg("{} of the {} are simulated operators, and count among people", f.simulated, f.n)});
  for (const auto& [candidate, s] : sat) {
    if (s->undecided()) f.to_look_at.push_back({s->seq, candidate, msg("verdict is review")});
    const json truth =
        s->result->value("perforation", json::object()).value("truth", json::object());
    if (!truth.is_object() || !truth.value("perforated", false)) continue;
    const json tissue = truth.value("tissue", json()), first_s = truth.value("first_t_s", json());
    const Term opened{tissue.is_string() ? tissue.get<std::string>() : "pulp"};
    f.to_look_at.push_back({s->seq, candidate,
                            first_s.is_number() ? msg("perforated the {} at {}", opened,
                                                      as_s(first_s.get<double>(), 1))
                                                : msg("perforated the {}", opened)});
  }
}

void note_few(ClassFigures& f, bool there, const char* figure, std::size_t n, std::size_t enough) {
  if (there && n < enough) f.few.push_back({figure, n, enough});
}

/// A result's criteria with their points: equal where what they say can be compared.
std::vector<std::string> criteria_of(const json& result) {
  std::vector<std::string> out;
  for (const auto& c : result.at("criteria"))
    out.push_back(fmt::format("{} {}", c.at("id").get<std::string>(), c.at("max").get<double>()));
  return out;
}

/// A result marked as most were.
const json& result_by(const MarkedBy& most, const CountingSessions& sat) {
  return *std::find_if(sat.begin(), sat.end(), [&](const auto& s) {
            return criteria_of(*s.second->result) == most.criteria;
          })->second->result;
}

/// The points of a class.
struct ClassPoints {
  std::vector<double> in_order;  // by candidate
  Matrix by_criterion;           // a row for each who was marked by the same criteria
  std::map<std::string, std::vector<double>> by_station;  // by its key
};

/// Counts the verdicts, too. `any`: whose criteria are compared.
ClassPoints points_of(ClassFigures& f, const CountingSessions& sat, const json& any) {
  ClassPoints all;
  for (const auto& [candidate, s] : sat) {
    const double points = points_in(*s->result, f.max_points);
    all.in_order.push_back(points);
    const Verdict verdict = grading::verdict_in(*s->result);
    (verdict == Verdict::pass ? f.pass : verdict == Verdict::fail ? f.fail : f.review) += 1;
    all.by_station[s->station_key].push_back(points);
    if (!s->simulated.empty()) ++f.simulated;
    if (criteria_of(*s->result) != criteria_of(any)) continue;  // regraded by another rubric
    std::vector<double> row;
    for (const auto& c : s->result->at("criteria")) row.push_back(c.at("points").get<double>());
    all.by_criterion.push_back(std::move(row));
  }
  return all;
}

/// Mean and spread, and who lies far from them.
void put_points(ClassFigures& f, const CountingSessions& sat, const std::vector<double>& in_order) {
  f.n = in_order.size();
  f.mean = cohort::mean(in_order);
  if (f.n >= 2) f.sd = std::sqrt(variance(in_order));
  std::size_t i = 0;
  for (const auto& [candidate, s] : sat) {
    if (f.sd > 0 && std::fabs(in_order[i] - f.mean) > k_far * f.sd)
      f.to_look_at.push_back(
          {s->seq, candidate, msg("{} points lie far from the class", as_points(in_order[i]))});
    ++i;
  }
  f.points = in_order;
  std::sort(f.points.begin(), f.points.end());
}

/// With two candidates and two criteria something can be said of how they go together.
bool enough_to_compare(const Matrix& by_criterion) {
  return by_criterion.size() >= 2 && by_criterion[0].size() >= 2;
}

/// How hard each criterion was and how well it tells candidates apart; how reliable all are
/// together.
void put_criteria(ClassFigures& f, const json& any, const Matrix& table) {
  const bool enough = enough_to_compare(table);
  const auto telling = enough ? discrimination(table) : std::vector<double>();
  for (std::size_t c = 0; c < any.at("criteria").size(); ++c) {
    const json& criterion = any["criteria"][c];
    double sum = 0;
    for (const auto& row : table) sum += row[c];
    CriterionFigures one{
        criterion.value("id", ""),
        criterion.value("metric", ""),
        sum / static_cast<double>(table.size()) / criterion.at("max").get<double>(),
        {}};
    if (enough) one.discrimination = telling[c];
    f.criteria.push_back(std::move(one));
  }
  if (enough && f.sd > 0) {
    f.alpha = cronbach_alpha(table);
    f.sem = standard_error(f.sd, *f.alpha);
  }
}

void put_stations(ClassFigures& f, const records::Registry& registry,
                  const std::map<std::string, std::vector<double>>& by_station) {
  std::vector<std::vector<double>> groups;
  for (const auto& [key, points] : by_station) {
    f.stations.push_back({key, station_label(registry, key), points.size(), cohort::mean(points)});
    groups.push_back(points);
  }
  if (groups.size() >= 2 && f.n > groups.size())
    f.station_effect = group_effect(groups, k_shuffles, 1);
}

/// Names the figures that rest on too few.
void put_few(ClassFigures& f, const Matrix& by_criterion) {
  note_few(f, f.alpha.has_value(), "alpha", by_criterion.size(), k_enough_for_alpha);
  note_few(f, f.sem.has_value(), "standard_error", by_criterion.size(), k_enough_for_alpha);
  note_few(f, enough_to_compare(by_criterion), "discrimination", by_criterion.size(),
           k_enough_for_alpha);
  note_few(f, f.agreement.icc.has_value(), "icc", f.agreement.n - f.agreement.incomplete,
           k_enough_for_icc);
  note_few(f, f.agreement.limits.has_value(), "limits", f.agreement.n, k_enough_for_limits);
  note_few(f, f.agreement.kappa.has_value(), "weighted_kappa", f.agreement.n, k_enough_for_kappa);
  note_few(f, f.agreement.cut.has_value(), "borderline_cut", f.agreement.rated, k_enough_for_cut);
}

}  // namespace

std::vector<HumanMark> parse_marks(const std::string& text, records::Identities& identities,
                                   const std::string& exam, const std::string& where,
                                   double max_points) {
  const auto rows = parse_csv(text, where);
  const auto at = [&](const CsvRow& row) { return FileLocation{where, row.line, 0}; };
  const bool known = !rows.empty() && rows[0].fields.size() >= 3 && rows[0].fields.size() <= 4 &&
                     rows[0].fields[0] == "candidate" && rows[0].fields[1] == "judge" &&
                     rows[0].fields[2] == "points" &&
                     (rows[0].fields.size() == 3 || rows[0].fields[3] == "rating");
  if (!known)
    throw Error(FileError::malformed, FileLocation{where, 1, 0}, msg("is no heading of marks"),
                msg("begin with candidate,judge,points or candidate,judge,points,rating"));
  std::vector<HumanMark> out;
  std::set<std::string> judges;
  std::set<std::pair<std::string, std::string>> given;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto& f = rows[i].fields;
    const auto number_in = [&](const std::string& field, const Message& column,
                               const Message& wrong) {
      double v = 0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), v);
      if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(v))
        throw Error(FileError::wrong_type, msg("{}: {}", at(rows[i]), column), wrong,
                    msg("write it with a decimal point"));
      return v;
    };
    HumanMark m{f[0],
                f[1],
                number_in(f[2], msg("column 3 (points)"), msg("'{}' is no number of points", f[2])),
                {}};
    if (m.judge.empty())
      throw Error(FileError::missing, at(rows[i]), msg("names no judge"),
                  msg("give each judge a name or number"));
    if (m.points < 0 || m.points > max_points)
      throw Error(
          FileError::out_of_range, msg("{}: {}", at(rows[i]), msg("column 3 (points)")),
          m.points < 0 ? msg("{} is less than no points", m.points)
                       : msg("{} is more than the exam's {} points", m.points, max_points),
          msg("write points of the exam's own scale, 0 to {}; nothing of the file was taken",
              max_points));
    const auto enrolled = identities.of_id(m.candidate);
    for (const auto& e : enrolled)
      if (e.exam == exam || e.exam.empty()) m.candidate = e.pseudonym;
    if (f.size() == 4 && !f[3].empty())
      m.rating =
          number_in(f[3], msg("column 4 (rating)"), msg("'{}' is no number of a rating", f[3]));
    if (!given.emplace(m.candidate, m.judge).second)
      throw Error(FileError::duplicate, at(rows[i]),
                  msg("is a second mark by judge {} for one candidate", m.judge),
                  msg("leave one of them"));
    judges.insert(m.judge);
    out.push_back(std::move(m));
  }
  require_distinct_judges(judges, Name{where});
  if (out.empty())
    throw Error(FileError::missing, Name{where}, msg("holds no mark"),
                msg("write a row for each candidate and judge"));
  return out;
}

CountingSessions counting_sessions(const records::Registry& registry, const std::string& exam) {
  CountingSessions sat;
  for (const auto& s : registry.sessions)
    if (s.scenario_id == exam && !s.doubtful() && !s.made_up_by && s.result->is_object())
      sat[s.candidate] = &s;
  if (sat.empty())
    throw Error(msg("exam '{}'", one_line(exam)), msg("was sat by nobody in this ledger"),
                msg("see `cavum ledger show` for what was"));
  return sat;
}

std::vector<MarkedBy> marked_by(const CountingSessions& sat) {
  std::vector<MarkedBy> out;
  for (const auto& [candidate, s] : sat) {
    const records::ExamScale scale = records::scale_in(*s->result);
    const records::Regrade* regrade = s->regrade(s->result_seq);
    MarkedBy by{0,
                scale.pass_percent,
                scale.borderline_percent,
                regrade != nullptr ? regrade->documents : decltype(MarkedBy::documents){},
                criteria_of(*s->result),
                1};
    for (const auto& r : s->regrades)  // a decision after a regrade is marked by what that one was
      if (by.entry == 0 && r.documents == by.documents &&
          !(by.documents.empty() && !r.person.empty()))
        by.entry = r.seq;
    const auto same = std::find_if(out.begin(), out.end(), [&](const MarkedBy& o) {
      return o.pass_percent == by.pass_percent && o.borderline_percent == by.borderline_percent &&
             o.documents == by.documents && o.criteria == by.criteria;
    });
    if (same == out.end()) {
      out.push_back(std::move(by));
      continue;
    }
    ++same->n;
    same->entry = std::min(same->entry, by.entry);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const MarkedBy& a, const MarkedBy& b) { return a.n > b.n; });
  return out;
}

std::optional<double> one_pass_percent(const std::vector<MarkedBy>& by) {
  const bool one = !by.empty() && std::all_of(by.begin(), by.end(), [&](const MarkedBy& b) {
    return b.pass_percent == by[0].pass_percent;
  });
  return one ? std::optional(by[0].pass_percent) : std::nullopt;
}

std::string station_label(const records::Registry& registry, const std::string& key) {
  constexpr std::size_t k_shown = 8;
  std::string beginning = key.size() > k_shown ? key.substr(0, k_shown) + "…" : key;
  const records::Station* own = registry.stations.of(key);
  if (own == nullptr || own->name.empty()) return beginning;
  const auto& all = registry.stations.stations;
  const bool twice = std::any_of(all.begin(), all.end(), [&](const records::Station& s) {
    return s.name == own->name && s.public_key != key;
  });
  return twice ? fmt::format("{} ({})", own->name, beginning) : own->name;
}

double points_of_exam(const records::Registry& registry, const std::string& exam) {
  return scale_of(registry, exam, counting_sessions(registry, exam)).max;
}

ClassFigures class_figures(const records::Registry& registry, const std::string& exam,
                           const std::vector<HumanMark>& marks, double borderline) {
  ClassFigures f;
  f.exam = exam;
  const auto sat = counting_sessions(registry, exam);
  const records::ExamScale scale = scale_of(registry, exam, sat);
  f.max_points = scale.max;
  f.marked_by = marked_by(sat);
  if (const auto percent = one_pass_percent(f.marked_by))
    f.pass_points = scale.max * *percent / 100;
  const json& any = result_by(f.marked_by.front(), sat);
  const ClassPoints points = points_of(f, sat, any);
  put_points(f, sat, points.in_order);
  put_criteria(f, any, points.by_criterion);
  put_stations(f, registry, points.by_station);
  f.walls = walls_of(sat);
  look_at_sessions(f, registry, sat);
  const GivenMarks given = marks_given(f, sat, marks);
  const MarkPairs pairs =
      pair_marks(given, sat, f, scale.max * f.marked_by.front().borderline_percent / 100);
  const bool one_band = std::all_of(f.marked_by.begin(), f.marked_by.end(), [&](const MarkedBy& b) {
    return b.borderline_percent == f.marked_by[0].borderline_percent;
  });
  put_agreement(f.agreement, given, pairs, borderline, f.pass_points && one_band);
  look_at_disagreements(f, sat, given, pairs);
  put_few(f, points.by_criterion);
  std::stable_sort(f.to_look_at.begin(), f.to_look_at.end(),
                   [](const ToLookAt& a, const ToLookAt& b) { return a.session < b.session; });
  return f;
}

}  // namespace cavum::cohort
