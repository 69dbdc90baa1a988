// One exam as a class sat it: the figures of statistics.h on the results that the ledger holds,
// with people's marks beside them where there are any.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "grading/cohort/statistics.h"
#include "grading/records/filing.h"
#include "grading/records/identities.h"

namespace cavum::cohort {

/// One mark that a person gave: points on the exam's scale, and a global rating where one was asked
/// for.
struct HumanMark {
  std::string candidate;  ///< pseudonym
  std::string judge;
  double points = 0;
  std::optional<double> rating;
};
/// CSV `candidate,judge,points[,rating]`, candidates by pseudonym or the school's own number.
/// Throws Error(where:line: column …) for anything else, and for points below 0 or above
/// `max_points`: nothing of such a file is taken.
[[nodiscard]] std::vector<HumanMark> parse_marks(const std::string& text,
                                                 records::Identities& identities,
                                                 const std::string& exam, const std::string& where,
                                                 double max_points);

struct CriterionFigures {
  std::string id, metric;
  double difficulty = 0;                 ///< mean share of its points, 0 hard .. 1 easy
  std::optional<double> discrimination;  ///< correlation with the sum of the others
};
struct WallFigures {
  std::string wall;
  std::size_t n = 0;               ///< candidates who cut it
  double mean_mm = 0, p95_mm = 0;  ///< over them: signed distance from the target's wall, + =
                                   ///< overcut; and its 95th percentile
  double worst_mm = 0;             ///< the largest overcut of all
};
struct StationFigures {
  std::string key;   ///< public
  std::string name;  ///< station_label
  std::size_t n = 0;
  double mean = 0;
};
struct Agreement {
  std::size_t n = 0;       ///< candidates that people marked
  std::optional<Icc> icc;  ///< program and judges as judges, candidates that all of them marked
  std::size_t judges = 0;  ///< people
  std::size_t incomplete =
      0;                  ///< of the candidates, not marked by all of them: left out of the ICC
  std::size_t rated = 0;  ///< of the candidates, that got a global rating
  std::optional<LimitsOfAgreement> limits;  ///< program less the mean of the judges, points
  std::optional<double> kappa;              ///< fail, borderline, pass: quadratic weights
  std::optional<double> cut;                ///< borderline regression, points
};
struct ToLookAt {
  std::uint64_t session = 0;  ///< entry
  std::string candidate;
  Message why;
};

// How many candidates a figure should come from at least; with fewer it is shown, and called a
// rough guess.
inline constexpr std::size_t k_enough_for_alpha =
    30;  ///< also its standard error, discrimination: Yurdugül, Hacettepe J. Educ. 35 (2008) 397
inline constexpr std::size_t k_enough_for_icc =
    30;  ///< Koo and Li, J. Chiropractic Medicine 15 (2016) 155
inline constexpr std::size_t k_enough_for_limits =
    30;  ///< either limit is then known to 0.6 sd: 1.96·sqrt(3/n), Bland and Altman 1986
inline constexpr std::size_t k_enough_for_kappa =
    18;  ///< 2k² for k = 3 bands: Cicchetti, Appl. Psychol. Measurement 5 (1981) 101
inline constexpr std::size_t k_enough_for_cut =
    50;  ///< Homer and others, Medical Teacher 38 (2016) 181: resampled classes of 15 to 300
/// A figure from too few.
struct Few {
  std::string figure;  ///< alpha, standard_error, discrimination, icc, limits, weighted_kappa,
                       ///< borderline_cut
  std::size_t n = 0, enough = 0;
};

/// What results of one exam were marked by: a rubric and a pass mark.
struct MarkedBy {
  std::uint64_t entry = 0;  ///< of the first regrade by it that counts; 0: as the exam was sat
  double pass_percent = 0.0, borderline_percent = 0.0;
  std::map<std::string, std::string> documents;  ///< of the regrade; empty: the exam's own
  std::vector<std::string> criteria;  ///< what each of them is called and how many points it gives
  std::size_t n = 0;                  ///< candidates
};

struct ClassFigures {
  std::string exam;
  std::size_t n = 0, pass = 0, fail = 0, review = 0;
  std::size_t simulated = 0;  ///< of n, sat by a simulated operator
  double max_points = 0, mean = 0, sd = 0;
  std::vector<MarkedBy> marked_by;  ///< the most frequent first
  std::optional<double>
      pass_points;  ///< by which all were marked; none: they were marked by different pass marks
  std::vector<double> points;  ///< ascending
  std::vector<CriterionFigures> criteria;
  std::optional<double> alpha, sem;
  std::vector<WallFigures> walls;  ///< that anybody cut
  std::vector<StationFigures> stations;
  std::optional<GroupEffect> station_effect;
  Agreement agreement;
  std::vector<Few> few;
  std::vector<ToLookAt> to_look_at;
};
/// "few: 12 candidates, under 30 it is a rough guess", or nothing when the figure comes from enough
/// or is not there.
[[nodiscard]] Message few_words(const ClassFigures& figures, const std::string& figure);
/// How results were marked differently, in a sentence; empty where all were marked alike.
[[nodiscard]] Message marked_by_words(const std::vector<MarkedBy>& marked_by);
/// A station's name in the ledger, with the beginning of its key where two have it; the beginning
/// of its key where it has none.
[[nodiscard]] std::string station_label(const records::Registry& registry, const std::string& key);

/// By candidate: the order of the ledger tells nothing.
using CountingSessions = std::map<std::string, const records::FiledSession*>;
/// Who sat an exam, by candidate. Of several sessions of one candidate the last counts; those filed
/// with findings do not. Throws Error when nobody sat it.
[[nodiscard]] CountingSessions counting_sessions(const records::Registry& registry,
                                                 const std::string& exam);
/// What each of `sat` was marked by, the most frequent first.
[[nodiscard]] std::vector<MarkedBy> marked_by(const CountingSessions& sat);
/// The pass mark, percent, by which all of them were marked; none where there are several.
[[nodiscard]] std::optional<double> one_pass_percent(const std::vector<MarkedBy>& marked_by);
/// The scale on which the exam was sat.
[[nodiscard]] double points_of_exam(const records::Registry& registry, const std::string& exam);
/// Over the sessions that count. `borderline`: the rating that means so. Throws Error when nobody
/// sat the exam.
[[nodiscard]] ClassFigures class_figures(const records::Registry& registry, const std::string& exam,
                                         const std::vector<HumanMark>& marks, double borderline);
[[nodiscard]] nlohmann::json to_json(const ClassFigures& figures);
/// The same for people to read.
[[nodiscard]] Lines to_text(const ClassFigures& figures);

}  // namespace cavum::cohort
