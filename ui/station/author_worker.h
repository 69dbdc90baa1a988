// Lays an author's zones into the tooth and checks the scenario, in a thread of its own: both take
// a second or more, and the window never waits. Only the newest text counts; what came before it
// and has not begun is left out.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/tooth/tooth.h"
#include "scenarios/file/parse.h"
#include "scenarios/zones/zone_map.h"
#include "ui/station/author_landmarks.h"
#include "ui/station/author_zones.h"
#include "ui/station/instrument_mesh.h"

namespace cavum::station {

/// What is to be looked at.
struct AuthorTask {
  std::uint64_t version = 0;  ///< of text and landmarks
  std::uint64_t reading = 0;  ///< of the files: the tooth is read anew with another number
  std::string text, path;
  std::vector<NamedPoint> landmarks;  ///< that a person put, in place of those in the tooth's file
};

/// What is known of one text and its landmarks. It comes twice: with the zones, and again when all
/// is checked.
struct AuthorFindings {
  std::uint64_t version = 0;                 ///< of text and landmarks
  std::shared_ptr<const AuthorTooth> tooth;  ///< null when the scenario's cannot be read
  std::array<MeshData, k_author_layers>
      body;  ///< surfaces of the zones, by layer; all empty when there are none
  Vec3 target_low_mm, target_high_mm;
  double opening_z_mm = 0.0;
  Vec3 chamber_mm;  ///< middle of the pulp chamber, where the scenario counts from it
  bool checked = false;
  std::vector<scenarios::Problem> problems;
  std::optional<double> expert_s;
};

class AuthorWorker {
 public:
  AuthorWorker() : thread_([this](const std::stop_token& stop) { work(stop); }) {}
  /// The next text to look at; never waits for more than a few bytes to be copied.
  void look_at(AuthorTask task);
  /// What was found since the last call, if anything was.
  [[nodiscard]] std::unique_ptr<AuthorFindings> take();

 private:
  void work(const std::stop_token& stop);
  void find(const AuthorTask& task);
  /// Null when the text names none that can be read.
  [[nodiscard]] std::shared_ptr<const AuthorTooth> tooth_of(const scenarios::Scenario& scenario,
                                                            std::uint64_t reading);
  void publish(AuthorFindings findings);

  std::mutex mutex_;  // of what stands below it, down to the tooth
  std::condition_variable_any asked_;
  std::optional<AuthorTask> task_;
  std::unique_ptr<AuthorFindings> found_;
  std::shared_ptr<const AuthorTooth> tooth_;  // of the worker alone
  std::uint64_t reading_ = 0;
  std::jthread thread_;  // the last: it ends first
};

/// The surfaces of the zones for the screen, smoothed: what is to be removed, that with its leeway,
/// that with its container, what is protected.
[[nodiscard]] std::array<MeshData, k_author_layers> zone_bodies(const scenarios::ZoneMap& zones,
                                                                const Octree& tooth);

}  // namespace cavum::station
