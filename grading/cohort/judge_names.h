// Names of judges, as people type them.
#pragma once

#include <set>
#include <string>

namespace cavum::cohort {

/// Throws Error that names two of `names` which differ by upper and lower case (of Latin letters)
/// or blanks alone: they would count as two judges.
void require_distinct_judges(const std::set<std::string>& names, const Message& where);

}  // namespace cavum::cohort
