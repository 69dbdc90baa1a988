#include "scenarios/review/tooth_task.h"

#include <fmt/core.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/anatomy/polylines.h"
#include "scenarios/review/adjacent_task.h"
#include "scenarios/review/check.h"
#include "scenarios/review/over_pulp.h"
#include "scenarios/review/ridge_margins.h"
#include "scenarios/review/task_texts.h"
#include "scenarios/review/tooth_task_parts.h"
#include "scenarios/zones/relief.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {
namespace {

// Preparation guides: the isthmus about a quarter of the distance between cusps, 1.2 to 1.5 mm; 1.5
// to 2 mm deep from the fissure, 0.2 to 0.5 mm of it in dentin; 1.6 mm of each marginal ridge
// stays, less on a small tooth; the box's axial wall 1.2 to 1.5 mm from the surface, its floor half
// a millimetre below the contact and clear of the neck (Sturdevant's Art and Science of Operative
// Dentistry, amalgam classes I and II).
constexpr double k_isthmus_share = 0.25, k_narrowest_mm = 1.2, k_widest_mm = 1.5;
constexpr double k_box_share = 0.33, k_box_narrowest_mm = 2.2, k_box_widest_mm = 4.0;
constexpr double k_below_contact_mm = 0.5, k_min_above_neck_mm = 0.8;
constexpr double k_in_dentin_mm = 0.2;
constexpr double k_min_walls_mm3 =
    0.6;  // twice what the template's criterion on walls gives full marks for

/// Sound ones looked at: the first without a warning that passes its trial is taken.
constexpr std::size_t k_max_tried = 4;
// The last step of a task asks for 87 % of the cavity, and the expert removes some 3 % less than
// that reach.
constexpr double k_min_reach = 0.895;

/// What of a task follows landmarks; its texts are the file of its name in data/tasks.
struct ToothTask {
  const char* word;
  Message (*why_not)(const Tooth&, const Landmarks&);
  std::vector<TaskChoice> (*choices)(const Tooth&, const Landmarks&);
  int opens = 0;            // the side on which it opens the contact: mesial 1, distal -1
  bool spares_pulp = true;  // an access opens it; a lesion may reach as far as it likes
};

bool has_tissue(const Tooth& tooth, const char* name) {
  return std::any_of(tooth.tissues.begin(), tooth.tissues.end(), [&](const Tissue& t) {
    return t.name == name && tooth.octree.count_leaves()[t.id] > 0;
  });
}

/// From the buccal to the lingual cusps, mm: of the two tips furthest apart across the tooth.
double across_mm(const Landmarks& l) {
  double low = 1e9, high = -1e9;
  for (const auto& c : l.cusps) {
    low = std::min(low, c.tip_mm.y);
    high = std::max(high, c.tip_mm.y);
  }
  return high > low ? high - low : 0.0;
}

double crown_width_mm(const Landmarks& l) {
  double low = 1e9, high = -1e9;
  for (const Vec3& p : l.height_of_contour_mm) {
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  return high > low ? high - low : 0.0;
}

/// Enamel over the deepest place of the fissure, mm; 0 where there is none.
double enamel_under_fissure_mm(const Tooth& tooth, const Landmarks& l) {
  const TissueRelief enamel = tissue_relief(tooth, "enamel", TissuePart::all, Name{tooth.name});
  double surface = 1e9, border = 1e9;
  for (const Vec3& p : l.central_fissure_mm) {
    surface = std::min(surface, p.z);
    border = std::min(border, enamel.floor_mm.at(p.x, p.y));
  }
  return std::max(0.0, surface - border);
}

/// To a tenth, as the task says it.
double isthmus_mm(const Landmarks& l) {
  return 0.1 *
         std::round(10.0 * std::clamp(k_isthmus_share * across_mm(l), k_narrowest_mm, k_widest_mm));
}

/// Floors of an occlusal cavity, deepest first: from the surface where that ends in dentin, else
/// from the border of enamel and dentin.
struct Floor {
  std::string toml;
  Message words;
};
std::vector<Floor> floors(const Tooth& tooth, const Landmarks& l) {
  std::vector<Floor> list;
  const double enamel_mm = enamel_under_fissure_mm(tooth, l);
  const auto below_lowest = [](double depth) {
    return fmt::format("{{ kind = \"below_lowest\", depth_mm = {} }}", fixed(depth, 1));
  };
  for (const double depth : {1.8, 1.5})
    if (depth >= enamel_mm + k_in_dentin_mm)
      list.push_back({below_lowest(depth), msg("{} below the fissure", as_mm(depth, 1))});
  for (const double depth : {0.5, 0.3, 0.2})
    list.push_back({fmt::format("{{ kind = \"below_border\", depth_mm = {} }}", fixed(depth, 1)),
                    msg("{} into dentin", as_mm(depth, 1))});
  for (const double depth : {1.2, 1.0})  // a worn crown, its pulp near: in enamel then
    list.push_back(
        {below_lowest(depth), depth < enamel_mm + k_in_dentin_mm
                                  ? msg("{} below the fissure, in part in enamel", as_mm(depth, 1))
                                  : msg("{} below the fissure", as_mm(depth, 1))});
  return list;
}

/// `what`, and which pit stays.
Message with_pits(Message what, const std::array<bool, 2>& left) {
  if (left[0] && left[1]) return msg("{} Both pits lie beside the cavity and stay.", what);
  if (left[0]) return msg("{} The mesial pit lies beside the cavity and stays.", what);
  if (left[1]) return msg("{} The distal pit lies beside the cavity and stays.", what);
  return what;
}
/// The lengths, and the same, for people.
Message chosen_with_pits(List lengths, const std::array<bool, 2>& left) {
  if (left[0]) lengths.items.push_back(msg("the mesial pit stays"));
  if (left[1]) lengths.items.push_back(msg("the distal pit stays"));
  return msg("{}", std::move(lengths));
}

template <int k_through>
Message no_fissure(const Tooth&, const Landmarks& l) {
  if (l.central_fissure_mm.size() < 2) return msg("no central fissure is found on it");
  const Message why = ridge_margins(l, isthmus_mm(l), k_through).why_none;
  return why.empty()
             ? Message()
             : msg("{}; see `cavum tooth show`, and put ridge or pits by hand where they are wrong",
                   why);
}

std::vector<TaskChoice> class_1(const Tooth& tooth, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const double width = isthmus_mm(l);
  const RidgeMargins ridges = ridge_margins(l, width, 0);
  for (const Floor& floor : floors(tooth, l))
    for (const RidgeMargin& margin : ridges.may)
      list.push_back({.gaps = {gap_mm("width", width, 1),
                               gap_mm("ridge", margin.ridge_mm, 1),
                               {"floor", floor.toml, floor.words},
                               gap_mm("left", 0.1 * std::floor(10.0 * margin.left_mm + 1e-6), 1)},
                      .pits_left = ridges.pits_left,
                      .floor = floor.toml});
  return list;
}

Message no_contact(const Landmarks& l, int side) {
  return furthest_along(l.height_of_contour_mm, Vec3{1.0 * side, 0, 0}) == nullptr ||
                 furthest_along(l.neck_mm, Vec3{1.0 * side, 0, 0}) == nullptr
             ? msg("its contact area or its neck is not found")
             : Message();
}
template <int k_side>
Message no_step(const Tooth& tooth, const Landmarks& l) {
  const Message fissure = no_fissure<k_side>(tooth, l);
  return fissure.empty() ? no_contact(l, k_side) : fissure;
}
template <int k_side>
Message no_box(const Tooth&, const Landmarks& l) {
  return l.incisal_edge_mm.empty() ? no_contact(l, k_side) : msg("a front tooth has no such box");
}

template <int k_side, bool k_with_step>
std::vector<TaskChoice> box(const Tooth& tooth, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const double above_neck =
      std::max(k_min_above_neck_mm,
               furthest_along(l.height_of_contour_mm, Vec3{1.0 * k_side, 0, 0})->z -
                   furthest_along(l.neck_mm, Vec3{1.0 * k_side, 0, 0})->z - k_below_contact_mm);
  const ContactBox beside =
      box_beside(tooth, l, k_side,
                 {std::clamp(k_box_share * crown_width_mm(l), k_box_narrowest_mm, k_box_widest_mm),
                  above_neck},
                 k_min_above_neck_mm, k_box_widest_mm);
  const RidgeMargins ridges = k_with_step ? ridge_margins(l, isthmus_mm(l), k_side)
                                          : RidgeMargins{};  // the other ridge stands
  constexpr double k_usual_ridge_mm = 1.2;
  const auto usual = std::find_if(ridges.may.begin(), ridges.may.end(), [](const RidgeMargin& m) {
    return m.ridge_mm <= k_usual_ridge_mm;
  });
  for (const double more : {0.0, 0.5, 1.0})
    for (const Floor& floor : k_with_step ? floors(tooth, l) : std::vector<Floor>{{}})
      for (const double axial : {1.5, 1.2}) {
        TaskChoice choice{
            .gaps = {gap_mm("box_width", beside.width_mm, 1), gap_mm("axial", axial, 1),
                     gap_mm("level", beside.above_neck_mm + more, 1)},
            .shell = beside.shell,
            .pits_left = ridges.pits_left};
        if (k_with_step)
          choice.gaps.insert(
              choice.gaps.end(),
              {gap_mm("width", isthmus_mm(l), 1),
               {"floor", floor.toml, floor.words},
               gap_mm("ridge", (usual != ridges.may.end() ? *usual : ridges.may[0]).ridge_mm, 1)});
        list.push_back(std::move(choice));
      }
  return list;
}

Message no_access(const Tooth& tooth, const Landmarks& l) {
  if (!has_tissue(tooth, "pulp")) return msg("it has no pulp");
  if (!l.incisal_edge_mm.empty()) return why_no_front_access(tooth, l);
  return l.chamber_roof_mm ? Message() : msg("no pulp chamber is found in it");
}
std::vector<TaskChoice> access(const Tooth& tooth, const Landmarks& l) {
  if (!l.incisal_edge_mm.empty()) return front_access(tooth, l);
  std::vector<TaskChoice> list;
  for (const auto& [wider, rounding] : {std::pair(0.1, 0.55),
                                        {0.1, 0.5},
                                        {0.2, 0.55},
                                        {0.3, 0.55}})  // a narrow chamber: as burs need it
    list.push_back(
        {.gaps = {gap_mm("wider", wider, 1), gap_mm("rounding", rounding, k_as_needed)}});
  return list;
}

Message no_lesion(const Tooth& tooth, const Landmarks&) {
  return has_tissue(tooth, "lesion") ? Message()
                                     : msg("it has no lesion: `cavum tooth lesion` grows one");
}
/// Of a tooth's lesion as much must go as in the lesion task that ships.
std::vector<TaskChoice> lesion(const Tooth& tooth, const Landmarks&) {
  constexpr double k_full = 0.87, k_zero = 0.58;
  const double mm3 = static_cast<double>(tooth.octree.count_leaves()[tooth.tissue_id("lesion")]) *
                     tooth.octree.leaf_volume_mm3();
  return {{.gaps = {{"lesion_mm3", fixed(mm3, 2)},
                    {"lesion_full", fixed(k_full * mm3, 2)},
                    {"lesion_zero", fixed(k_zero * mm3, 2)}}}};
}

constexpr std::array<ToothTask, 12> k_tasks{{{"class_1", no_fissure<0>, class_1},
                                             {"class_2_mesial", no_step<1>, box<1, true>, 1},
                                             {"class_2_distal", no_step<-1>, box<-1, true>, -1},
                                             {"slot_mesial", no_box<1>, box<1, false>, 1},
                                             {"slot_distal", no_box<-1>, box<-1, false>, -1},
                                             {"access", no_access, access, 0, false},
                                             {"lesion", no_lesion, lesion, 0, false},
                                             {"class_5", why_no_class_5, class_5},
                                             {"crown", why_no_crown, crown_preparation},
                                             {"dexterity_groove", why_no_dexterity, dexterity},
                                             {"dexterity_circle", why_no_dexterity, dexterity},
                                             {"dexterity_cross", why_no_dexterity, dexterity}}};

/// The criteria that follow what the tooth has.
std::string tooth_criteria(const TaskTexts& texts, const Tooth& tooth, int opens,
                           bool spares_pulp) {
  std::string text;
  for (const auto& name : adjacent_criteria(tooth, opens)) text += texts.filled(name, {});
  if (spares_pulp)
    text += texts.filled("over_pulp_criterion",
                         {{"over_pulp_full", fixed(k_planned_over_pulp_mm - 0.1, 1)},
                          {"over_pulp_least", fixed(k_min_over_pulp_mm, 1)}});
  return text;
}

std::string id_of(const std::string& tooth_file, const std::string& task) {
  std::string id;
  for (const char c : std::filesystem::path(tooth_file).stem().string() + "_" + task) {
    const char small = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    id += (small >= 'a' && small <= 'z') || (small >= '0' && small <= '9') || small == '-' ? small
                                                                                           : '_';
  }
  return id.substr(0, 60);
}

/// Tissues that the tooth has, of a TOML list of names.
std::string present(const Tooth& tooth, const std::string& list) {
  std::string kept;
  for (const auto& t : tooth.tissues)
    if (list.find("\"" + t.name + "\"") != std::string::npos)
      kept += fmt::format("{}\"{}\"", kept.empty() ? "" : ", ", t.name);
  return "[" + kept + "]";
}

/// The tooth, and what of it is only guessed or was not checked: lines of a comment.
std::string about(const Tooth& tooth) {
  std::string text = one_line(tooth.name);
  for (const auto& guess : tooth.notes_of(ToothNote::Kind::guess))
    text += "\n# Guessed by its shape: " + one_line(english_text(guess));
  for (const auto& warning : tooth.notes_of(ToothNote::Kind::warning))
    text += "\n# Notice: " + one_line(english_text(warning));
  return text;
}

/// Whole minutes, at least five: two and a half times what the expert needs.
double time_limit_s(const std::optional<double>& expert_s) {
  return 60.0 * std::max(5.0, std::ceil(2.5 * expert_s.value_or(0) / 60.0));
}

/// A share of the target's volume.
double wall_limit_mm3(const ZoneMap& zones, double share) {
  const double target_mm3 = static_cast<double>(zones.target_shares()) /
                            static_cast<double>(ZoneMap::k_share_units) * zones.leaf_volume_mm3();
  return std::max(k_min_walls_mm3, share * target_mm3);
}

}  // namespace

std::vector<std::string> tooth_task_words() {
  std::vector<std::string> words;
  for (const auto& t : k_tasks) words.emplace_back(t.word);
  return words;
}

std::string language_table(const Scenario& s, const Message& title, const Message& description,
                           const TaskLanguage& language) {
  if (language.name.empty()) return "";
  std::string lines;
  const auto add = [&](const std::string& key, const Message& english) {
    std::ostringstream text;
    text << toml::toml_formatter(toml::value<std::string>(language.say(english)),
                                 toml::format_flags::allow_unicode_strings);
    lines += fmt::format("{} = {}\n", key, text.str());
  };
  const auto add_known = [&](const std::string& key, const std::string& english) {
    const Message words = msg("{}", Term{english});
    if (language.say(words) != english) add(key, words);
  };
  add("title", title);
  add("description", description);
  for (const auto& step : s.steps) add_known("steps." + step.id, step.instruction);
  for (const auto& criterion : s.rubric.criteria)
    add_known("criteria." + criterion.id, criterion.title);
  return fmt::format("\n[languages.{}]\n{}", language.name, lines);
}

std::vector<OfferedTask> offered_tasks(const Tooth& tooth, const Landmarks& landmarks) {
  std::vector<OfferedTask> list;
  for (const auto& t : k_tasks)
    list.push_back({t.word, TaskTexts(t.word).sentence("title", {}), t.why_not(tooth, landmarks)});
  return list;
}

WrittenTask write_tooth_task(const Tooth& tooth, const Landmarks& landmarks,
                             const std::string& tooth_file, const std::string& path,
                             const std::string& task, const TaskTrial& trial,
                             const TaskLanguage& language) {
  const ToothTask* asked = nullptr;
  List words;
  for (const auto& t : k_tasks) {
    if (t.word == task)
      asked = &t;
    else
      words.items.emplace_back(Name{t.word});
  }
  const Name option{"--task " + task};
  if (asked == nullptr)
    throw Error(option, msg("there is no such task"), msg("choose one of {}", words));
  if (const Message why = asked->why_not(tooth, landmarks); !why.empty())
    throw Error(option, msg("'{}' is not fit for it: {}", tooth.name, why),
                msg("see `cavum tooth landmarks`, or choose another of {}", words));

  const TaskTexts texts(task);
  const bool spares_pulp = asked->spares_pulp && has_tissue(tooth, "pulp");
  const Message title = texts.sentence("title", {});
  const std::string criteria = tooth_criteria(texts, tooth, asked->opens, spares_pulp);
  Message refused, against;
  std::string too_deep;  // a floor that was left out for the pulp
  const auto holds = [&](const std::string& text) {
    against = trial ? trial(text) : Message();
    return against.empty();
  };
  std::vector<WrittenTask> unwise;  // sound, with warnings: only when there is none without
  std::size_t tried = 0;
  double reaches = 0, spares_mm = 0;  // the most of any choice that was left out for it
  for (const TaskChoice& choice : asked->choices(tooth, landmarks)) {
    if (!too_deep.empty() && choice.floor == too_deep) continue;
    const Message what =
        with_pits(texts.sentence("what", choice.gaps, choice.variant), choice.pits_left);
    const auto text_with = [&](double limit_s, const std::string& walls_limit) {
      Gaps gaps = choice.gaps;
      gaps.insert(gaps.end(), {{"id", id_of(tooth_file, task)},
                               {"title", english_text(title)},
                               {"what", english_text(what)},
                               {"tooth", tooth_file},
                               {"about", about(tooth)},
                               {"faults", present(tooth, texts.filled("faults", {}))},
                               {"time_limit_s", plain_number(limit_s)},
                               {"shell", choice.shell ? texts.filled("neighbour_shell", {}) : ""},
                               {"walls_limit", walls_limit},
                               {"tooth_criteria", criteria}});
      return texts.filled("scenario", gaps, choice.variant);
    };
    CheckedScenario checked = check_whole(text_with(7200, ""), path);
    if (checked.sound() && checked.expert.reach < k_min_reach) {
      reaches = std::max(reaches, checked.expert.reach);
    } else if (const double over_pulp = checked.laid && spares_pulp
                                            ? planned_over_pulp_mm(tooth, checked.laid->zones)
                                            : k_planned_over_pulp_mm;
               checked.sound() && over_pulp < k_planned_over_pulp_mm) {
      spares_mm = std::max(spares_mm, over_pulp);
      too_deep = choice.floor;
    } else if (checked.sound()) {
      const double walls_mm3 = wall_limit_mm3(checked.laid->zones, texts.number("walls_share"));
      const std::string written =
          text_with(time_limit_s(checked.expert.time_s),
                    texts.filled("walls_limit", {{"walls_mm3", fixed(walls_mm3, 1)}})) +
          language_table(checked.laid->scenario, title, what, language);
      checked = check_whole_in(*checked.laid, written, path);
      if (checked.sound()) {
        WrittenTask found{written, checked.problems,
                          chosen_with_pits(texts.sentences("chosen", choice.gaps, choice.variant),
                                           choice.pits_left)};
        if (!found.problems.empty())
          unwise.push_back(std::move(found));
        else if (holds(written))
          return found;
        if (++tried == k_max_tried) break;
      }
    }
    if (refused.empty() && !checked.problems.empty()) refused = checked.problems[0].what;
  }
  std::stable_sort(unwise.begin(), unwise.end(), [](const auto& a, const auto& b) {
    return a.problems.size() < b.problems.size();
  });
  for (WrittenTask& found : unwise)
    if (holds(found.text)) return found;

  if (!against.empty())
    throw Error(option, msg("tried on '{}', and not fit to be an exam: {}", tooth.name, against),
                msg("choose another task or tooth; --untried writes it all the same, as a draft"));
  if (spares_mm > 0)
    throw Error(option,
                msg("in '{}' its floor would lie {} from the pulp; {} are asked for", tooth.name,
                    as_mm(spares_mm, 1), as_mm(k_planned_over_pulp_mm, 1)),
                msg("choose another task or tooth"));
  if (reaches > 0)
    throw Error(
        Mistake::unreachable, option,
        msg("in '{}' no bur of its tray reaches more than {} of the cavity, which is too narrow for them",
            tooth.name, as_percent(100 * reaches, 0)),
        msg("choose another task or tooth"));
  throw Error(option, msg("'{}' has no room for it: {}", tooth.name, refused),
              msg("choose another task or tooth"));
}

}  // namespace cavum::scenarios
