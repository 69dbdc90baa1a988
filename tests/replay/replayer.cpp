// Replays and regrades recorded exams and prints, for each, one line that must be the same from
// every compiler and optimisation level: ticks, last state hash, SHA-256 of the graded result. Exit
// 1 when a session does not verify or grades differently than when it was sealed.
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/base/hash.h"
#include "engine/base/json_reader.h"
#include "engine/session/verify.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"

int main(int argc, char** argv) {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    try {
      const auto start = std::chrono::steady_clock::now();
      const auto report = cavum::verify_session(argv[i]);
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const cavum::SessionReader reader(argv[i]);
      const auto session = cavum::grading::load_for_grading(argv[i]);
      const std::string result =
          cavum::grading::to_json(cavum::grading::grade(session->input(), session->rubric)).dump();
      const nlohmann::json sealed = cavum::parse_json_or_null(reader.result_json());
      const bool same = nlohmann::json::parse(result) == sealed;
      std::printf("%s %s ticks %lld state %016llx result %s%s\n", argv[i],
                  report.verified ? "verified" : "NOT VERIFIED",
                  static_cast<long long>(report.ticks),
                  static_cast<unsigned long long>(reader.chunks().back().state_hash),
                  cavum::to_hex(cavum::sha256(result)).c_str(), same ? "" : " GRADED DIFFERENTLY");
      std::fprintf(stderr, "%s: %.0f times real time\n", argv[i],
                   static_cast<double>(report.ticks) * 1e-3 / seconds);
      for (const auto& f : report.findings)
        std::fprintf(stderr, "  %s\n", cavum::english_text(f.message()).c_str());
      good = good && report.verified && same;
    } catch (const std::exception& e) {
      std::printf("%s unreadable: %s\n", argv[i], e.what());
      good = false;
    }
  }
  return good ? 0 : 1;
}
