// The hands, a file each.
#pragma once

#include "tests/hands/hand.h"

namespace cavum::hands {

std::unique_ptr<Hand> make_plunger(const Task& task, Random random);
std::unique_ptr<Hand> make_miller(const Task& task, Random random);
std::unique_ptr<Hand> make_hesitant(const Task& task, Random random);
std::unique_ptr<Hand> make_expert(const Task& task, Random random);
std::unique_ptr<Hand> make_pecker(const Task& task, Random random);
std::unique_ptr<Hand> make_circler(const Task& task, Random random);
std::unique_ptr<Hand> make_novice(const Task& task, Random random);

}  // namespace cavum::hands
