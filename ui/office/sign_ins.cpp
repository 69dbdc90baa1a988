#include "ui/office/sign_ins.h"

#include <algorithm>

#include "engine/base/hash.h"
#include "grading/records/ledger_key.h"

namespace cavum::office {
namespace {

constexpr std::size_t k_sign_in_bytes = 32, k_max_keys = 10'000;

bool over(const SignedIn& s, std::int64_t now_s) {
  return now_s - s.seen_s > k_idle_end_s || now_s - s.begun_s > k_absolute_end_s;
}

}  // namespace

std::string SignIns::begin(const Account& account, std::int64_t now_s,
                           const std::string& proxied_as) {
  std::string cookie = records::random_hex(k_sign_in_bytes);
  const std::lock_guard lock(lock_);
  std::erase_if(by_hash_, [&](const auto& one) { return over(one.second, now_s); });
  if (by_hash_.size() >= k_max_sign_ins)
    by_hash_.erase(std::min_element(
        by_hash_.begin(), by_hash_.end(),
        [](const auto& a, const auto& b) { return a.second.seen_s < b.second.seen_s; }));
  by_hash_[to_hex(sha256(cookie))] = {account, records::random_hex(k_sign_in_bytes), now_s, now_s,
                                      proxied_as};
  return cookie;
}

std::optional<SignedIn> SignIns::of(const std::string& cookie, std::int64_t now_s) {
  const std::lock_guard lock(lock_);
  const auto found = by_hash_.find(to_hex(sha256(cookie)));
  if (found == by_hash_.end()) return std::nullopt;
  if (over(found->second, now_s)) {
    by_hash_.erase(found);
    return std::nullopt;
  }
  found->second.seen_s = now_s;
  return found->second;
}

bool SignIns::lasts(const std::string& cookie, std::int64_t now_s) {
  const std::lock_guard lock(lock_);
  const auto found = by_hash_.find(to_hex(sha256(cookie)));
  return found != by_hash_.end() && !over(found->second, now_s);
}

void SignIns::end(const std::string& cookie) {
  const std::lock_guard lock(lock_);
  by_hash_.erase(to_hex(sha256(cookie)));
}

bool Tries::allow(const std::string& key, std::size_t most, std::int64_t now_s) {
  const std::lock_guard lock(lock_);
  std::erase_if(by_key_, [&](const auto& one) { return now_s - one.second.since_s > k_tries_s; });
  if (by_key_.size() >= k_max_keys && !by_key_.contains(key)) return false;
  Counted& c = by_key_.try_emplace(key, Counted{now_s, 0}).first->second;
  if (c.n >= most) return false;
  ++c.n;
  return true;
}

void Tries::forget(const std::string& key) {
  const std::lock_guard lock(lock_);
  by_key_.erase(key);
}

}  // namespace cavum::office
