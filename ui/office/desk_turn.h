// One call at the desk: the ledger as it is now, for one thread, in the name of an actor.
#pragma once

#include <mutex>
#include <utility>

#include "ui/office/desk.h"

namespace cavum::office {

class Desk::Turn {
 public:
  explicit Turn(Desk& desk, records::Actor actor = {}) : guard_(desk.lock_), book(desk.ledger_) {
    book.refresh();
    book.act_for(std::move(actor));
  }
  ~Turn() { book.act_for({}); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::lock_guard<std::mutex> guard_;

 public:
  records::Ledger& book;
};

}  // namespace cavum::office
