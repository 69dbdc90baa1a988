// What became of a ticket, for command line and office alike.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/base/message.h"
#include "grading/records/registry.h"

namespace cavum::records {

enum class TicketStatus : std::uint8_t { live, begun, run_out, filed, cancelled, made_up };
[[nodiscard]] std::string_view name_of(TicketStatus group) noexcept;

struct TicketState {
  TicketStatus group = TicketStatus::live;
  Message words;
};
[[nodiscard]] TicketState state_of(const IssuedTicket& ticket, std::int64_t now_utc_ns);

}  // namespace cavum::records
