#include "ui/office/reports.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "grading/records/signed_note.h"

namespace cavum::office {
namespace {

constexpr int k_max_waiting = 8;
constexpr std::size_t k_max_kept = 8;

/// Of a page whose last script is its only one that runs. `sandbox` gives it an origin of its own:
/// no cookie of the office's goes with what it asks.
std::string policy_of(const std::string& html) {
  constexpr std::string_view k_begin = "<script>", k_end = "</script>";
  const auto begin = html.rfind(k_begin), end = html.rfind(k_end);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    return "default-src 'none'; sandbox";
  const std::string script = html.substr(begin + k_begin.size(), end - begin - k_begin.size());
  return fmt::format(
      "default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{}'; img-src data: blob:; base-uri 'none'; form-action 'none'; "
      "frame-ancestors "
      "'none'; sandbox allow-scripts allow-downloads",
      records::to_base64(sha256(script)));
}

struct Counted {
  explicit Counted(std::atomic<int>& n) : n_(n), place(++n) {}
  ~Counted() { --n_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  std::atomic<int>& n_;

 public:
  int place;
};

}  // namespace

Reply Reports::of(const Recording& recording) {
  const Counted counted(waiting_);
  if (counted.place > k_max_waiting)
    throw Error(msg("the report"), msg("waits behind too many others"),
                msg("ask again in a minute"));
  const std::lock_guard guard(lock_);
  auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) {
    return k.path == recording.path && k.entries == recording.entries;
  });
  if (found == kept_.end()) {
    if (!make_)
      throw Error(msg("the report"), msg("cannot be made by this server"),
                  msg("use `cavum report` with --ledger"));
    kept_.push_back({recording.path, recording.entries, make_(recording.path)});
    if (kept_.size() > k_max_kept) kept_.pop_front();
    found = std::prev(kept_.end());
  }
  Reply reply{200, "text/html; charset=utf-8", found->html};
  reply.fields.emplace_back("Content-Security-Policy", policy_of(found->html));
  return reply;
}

}  // namespace cavum::office
