// The exam office's server, put together: accounts, ledger, board, inbox, and a handler behind each
// route.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grading/records/filing.h"
#include "ui/office/http_server.h"
#include "ui/office/proxy.h"

namespace cavum::office {

struct OfficeOptions {
  std::string ledger_folder;
  SigningKey school;
  std::string home;  ///< folder of the office's own files, mode 0700: accounts.json, certificate,
                     ///< ID/tickets, ID/inbox
  std::vector<std::string> exams;  ///< scenario files
  std::string address = "127.0.0.1";
  std::uint16_t port = 8443;  ///< 0: any that is free
  CertificateFiles certificate;
  records::FilingOptions filing;
  /// The instructor's report (HTML) of the recording at a path, which the ledger holds; it may take
  /// seconds. Throws Error.
  std::function<std::string(const std::string& recording)> report;
  /// The same for the student whom it is about: of the released result alone.
  std::function<std::string(const std::string& recording)> student_report;
  HttpLimits limits;
  std::optional<ProxySignOn> proxy =
      {};  ///< who signs in by the school's own accounts; none: nobody
};

class Office {
 public:
  /// Serves from now on, in threads of its own. Throws Error when a part cannot be had.
  explicit Office(const OfficeOptions& options);
  /// Ends connections, and the exam that is being verified first.
  ~Office();
  Office(const Office&) = delete;
  Office& operator=(const Office&) = delete;
  [[nodiscard]] std::uint16_t port() const noexcept;
  /// What the server asks for each request: for whoever brings one on another way than a
  /// connection.
  [[nodiscard]] std::unique_ptr<Exchange> welcome(const Head& head);
  [[nodiscard]] const std::string& school() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cavum::office
