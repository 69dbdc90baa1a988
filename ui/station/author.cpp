#include "ui/station/author.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/say.h"
#include "ui/station/author_screen.h"
#include "ui/station/look.h"
#include "ui/station/script.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

using Clock = std::chrono::steady_clock;

class Author {
 public:
  Author(const StationOptions& options, const std::string& scenario)
      : document_(scenario),
        window_({"Cavum: authoring", options.width, options.height, options.monitor}) {
    if (!options.script.empty())
      script_ = Script(read_text_file(options.script), options.script, options.pictures);
    window_.walk_by_keys(false);  // every key has a meaning of its own here
    state_.screen = Screen::author_busy;
    state_.own_arrows = true;
    state_.left_handed = options.left_handed;
    state_.high_contrast = options.high_contrast;
    state_.text_scale = options.text_scale;
    state_.view.clear = true;
    state_.view.handpiece = false;
    state_.view.camera.look_from_occlusal();
    state_.view.camera.distance_mm = 30.0F;
  }

  int run() {
    while (!done_ && !ui::Interrupt::asked()) frame();
    if (!document_.unsaved() || discarded_) return 0;
    ui::say_error(msg("{}: was left with changes that are not saved; they are in {}",
                      document_.path(), list_of(document_.keep_aside())));
    return 1;
  }

 private:
  void frame() {
    const auto began = Clock::now();
    const double frame_s = std::min(0.1, seconds_since(last_frame_));
    last_frame_ = began;
    look_.follow(window_, state_);
    follow_text();
    follow_findings();
    script_.step(window_, state_.screen, 0.0, seconds_since(start_));
    window_.begin_frame();
    state_.view.stereo = false;  // points are shown for one eye
    const ScreenContext screen{look_.theme(), state_,  scenario_, shelf_, nullptr,
                               scene_.get(),  nullptr, frame_s,   true,   window_.input()};
    const AuthorContext context{
        screen,          document_,  author_,
        zones_,          landmarks_, busy() ? mistakes_ : findings_->problems,
        findings_.get(), busy(),     floor_z_mm_};
    const AuthorWish wish = author_screen(context);
    window_.end_frame();
    if (std::exchange(author_.shown_differs, false) || chosen_layer() != shown_layer_)
      show_bodies();
    grant(wish);
    if (window_.closing()) {
      window_.stay_open();
      grant(AuthorWish::close);
    }
    window_.rest(began);
  }

  [[nodiscard]] bool busy() const {
    return findings_ == nullptr || findings_->version != document_.version() || !findings_->checked;
  }

  /// What the text says, at once; what it means on the tooth, when the hand has rested for a
  /// moment.
  void follow_text() {
    if (document_.version() != read_version_) {
      scenarios::ReadScenario read = scenarios::read_scenario(document_.text(), document_.path());
      scenario_ = std::move(read.scenario);
      mistakes_ = std::move(read.problems);
      read_version_ = document_.version();
      changed_ = Clock::now();
      find_zones();
      find_marks();
    }
    constexpr double k_rest_s = 0.4;
    if (asked_version_ != document_.version() &&
        (asked_version_ == 0 || seconds_since(changed_) > k_rest_s)) {
      worker_.look_at({document_.version(), document_.reading(), document_.text(), document_.path(),
                       document_.landmarks()});
      asked_version_ = document_.version();
    }
    state_.screen = busy() ? Screen::author_busy : Screen::author;
  }

  void find_zones() {
    zones_ = author_zones(scenario_, opening_z_mm_, chamber_mm_);
    author_.zone = std::min(author_.zone, zones_.empty() ? 0 : zones_.size() - 1);
    if (zones_.empty()) return;
    const AuthorZone& chosen = zones_[author_.zone];
    author_.point =
        std::min(author_.point, chosen.points_mm.empty() ? 0 : chosen.points_mm.size() - 1);
    author_.number =
        std::min(author_.number, chosen.numbers.empty() ? 0 : chosen.numbers.size() - 1);
  }

  /// Where the hand has put them, at once.
  void find_marks() {
    landmarks_.clear();
    if (findings_ && findings_->tooth)
      landmarks_ = author_landmarks(findings_->tooth->found, document_.landmarks());
    author_.landmark = std::min(author_.landmark, landmarks_.empty() ? 0 : landmarks_.size() - 1);
  }

  void follow_findings() {
    auto found = worker_.take();
    if (!found) return;
    findings_ = std::move(found);
    if (findings_->tooth && findings_->tooth != shown_tooth_) {
      shown_tooth_ = findings_->tooth;
      scene_ = std::make_unique<Scene>(shown_tooth_->tooth.octree, shown_tooth_->tooth.tissues,
                                       shelf_, nullptr);
      bodies_version_ = 0;
    }
    find_marks();
    const bool laid = !findings_->body[0].indices.empty();
    if (laid) {
      const Vec3 low = findings_->target_low_mm, high = findings_->target_high_mm;
      opening_z_mm_ = findings_->opening_z_mm;
      chamber_mm_ = findings_->chamber_mm;
      floor_z_mm_ = low.z;
      if (!std::exchange(looked_, true))
        state_.view.camera.target_mm = {static_cast<float>((low.x + high.x) / 2),
                                        static_cast<float>((low.y + high.y) / 2),
                                        static_cast<float>((low.z + high.z) / 2)};
      if (bodies_version_ != findings_->version) {
        bodies_ = findings_->body;
        show_bodies();
        bodies_version_ = findings_->version;
      }
      find_zones();
    }
    state_.screen = busy() ? Screen::author_busy : Screen::author;
  }

  [[nodiscard]] std::size_t chosen_layer() const {
    return zones_.empty() ? 0 : static_cast<std::size_t>(zones_[author_.zone].layer);
  }

  /// That of the chosen zone stronger than the others.
  void show_bodies() {
    if (!scene_) return;
    std::vector<GpuMesh> meshes;
    shown_layer_ = chosen_layer();
    for (std::size_t i = k_author_layers; i-- > 0;) {  // the target over what surrounds it
      if (!author_.shown[i] || bodies_[i].indices.empty()) continue;
      std::vector<GpuVertex> vertices = bodies_[i].vertices;
      constexpr std::uint8_t k_strong = 190;
      if (i == shown_layer_)
        for (GpuVertex& v : vertices) v.colour[3] = k_strong;
      meshes.emplace_back().put(vertices, bodies_[i].indices);
    }
    scene_->show_bodies(std::move(meshes));
  }

  /// False when the tooth's new name has to be asked for first.
  bool save(bool close_then) {
    const bool named = std::exchange(author_.tooth_named, false);
    const auto suggestion = document_.new_tooth_name();
    if (suggestion && !named) {
      author_.tooth_name.fill(0);
      suggestion->copy(author_.tooth_name.data(), author_.tooth_name.size() - 1);
      author_.ask_tooth = true;
      author_.close_then = close_then;
      author_.message = {};
      return false;
    }
    author_.ask_tooth = suggestion.has_value();  // and asked again, should the name not do
    const std::string name = suggestion ? author_.tooth_name.data() : "";
    document_.save(name);
    author_.ask_tooth = false;
    author_.message =
        suggestion ? msg("Saved, and the tooth with its landmarks as {}.", name) : msg("Saved.");
    return true;
  }

  void grant(AuthorWish wish) {
    try {
      switch (wish) {
        case AuthorWish::save:
        case AuthorWish::save_and_close:
          done_ = save(wish == AuthorWish::save_and_close) && wish == AuthorWish::save_and_close;
          break;
        case AuthorWish::undo:
          author_.message = document_.undo() ? Message() : msg("There is nothing to take back.");
          break;
        case AuthorWish::redo:
          author_.message = document_.redo() ? Message() : msg("There is nothing to make again.");
          break;
        case AuthorWish::read_again:
          document_.read_again();
          author_.message = msg("Read again from the file.");
          break;
        case AuthorWish::close:
          author_.ask_close = document_.unsaved();
          done_ = !author_.ask_close;
          break;
        case AuthorWish::discard:
          done_ = discarded_ = true;
          break;
        case AuthorWish::none:
          break;
      }
    } catch (const Error& e) {
      author_.message = e.message();
    }
  }

  AuthorDocument document_;
  scenarios::Scenario scenario_;
  std::vector<scenarios::Problem> mistakes_;  // of the text alone
  std::vector<AuthorZone> zones_;
  std::vector<AuthorLandmark> landmarks_;
  std::vector<Bur> shelf_;
  ui::Interrupt interrupt_;
  Window window_;
  Script script_;
  StationState state_;
  AuthorState author_;
  Look look_;
  std::unique_ptr<Scene> scene_;
  std::shared_ptr<const AuthorTooth> shown_tooth_;
  std::unique_ptr<AuthorFindings> findings_;
  std::array<MeshData, k_author_layers> bodies_;
  double opening_z_mm_ = 0.0, floor_z_mm_ = 0.0;
  Vec3 chamber_mm_;
  std::size_t shown_layer_ = 0;
  std::uint64_t read_version_ = 0, asked_version_ = 0, bodies_version_ = 0;
  bool looked_ = false;  // at the first target
  bool done_ = false, discarded_ = false;
  Clock::time_point start_ = Clock::now(), last_frame_ = start_, changed_ = start_;
  AuthorWorker worker_;
};

}  // namespace

int run_author(const StationOptions& options, const std::string& scenario) {
  return Author(options, scenario).run();
}

}  // namespace cavum::station
