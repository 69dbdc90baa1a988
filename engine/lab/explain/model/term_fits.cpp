#include "engine/lab/explain/model/term_fits.h"

#include <algorithm>

namespace cavum::explain {
namespace {

constexpr std::size_t k_kept =
    12;  // blocks: those of a search over one shape beside five causes, and a few to come back to

}  // namespace

TermFits::TermFits(const View& view) : view_(view), white_(whitening_of(view)) {
  sums_.tried = narrower_spreads(view.spread);
  set_prior(sums_, view.scene->recording->rig);
  std::size_t fold = 0;
  for (const auto& s : view.scene->recording->sessions) {
    const Eigen::MatrixXd effects =
        view.white_effects->middleRows(s.begin, s.end - s.begin).cast<double>();
    sums_.sessions.push_back({s.begin, s.end, fold++, {}, effects.transpose() * effects, {}, {}});
  }
  Block base;
  add(base, *view.force_n);
  add(base, view.scene->spring_mm);
  add(base, view.scene->damper_mm_s);
  blocks_.push_back(std::move(base));
}

void TermFits::add(Block& block, Series column) {
  white_.apply(column);
  block.white.conservativeResize(column.size(), block.white.cols() + 1);
  block.white.rightCols(1) = column.matrix();
}

TermFits::Block TermFits::made(const Term& term) {
  const Mechanism& m = mechanism_at(term.mechanism);
  Columns c = m.columns(*view_.scene, term.shape);
  Block block;
  block.term = term;
  block.repeats =
      m.by_session ? static_cast<Eigen::Index>(session_groups(*view_.scene->recording)) : 1;
  block.own = static_cast<Eigen::Index>(c.own.size()) / block.repeats;
  for (Eigen::Index i = 0; i < block.own; ++i) {
    Series whole =
        std::move(c.own[static_cast<std::size_t>(i)]);  // those of sessions do not overlap
    for (Eigen::Index s = 1; s < block.repeats; ++s)
      whole += c.own[static_cast<std::size_t>(s * block.own + i)];
    add(block, std::move(whole));
  }
  if (c.spring.size() > 0) block.spring = block.white.cols(), add(block, std::move(c.spring));
  if (c.damper.size() > 0) block.damper = block.white.cols(), add(block, std::move(c.damper));
  return block;
}

TermFits::Block* TermFits::block_of(const Term& term) {
  for (auto at = std::next(blocks_.begin()); at != blocks_.end(); ++at)
    if (at->term.mechanism == term.mechanism && at->term.shape == term.shape) {
      blocks_.splice(std::next(blocks_.begin()), blocks_, at);
      return &*at;
    }
  blocks_.insert(std::next(blocks_.begin()), made(term));
  return &*std::next(blocks_.begin());
}

const std::vector<Eigen::MatrixXd>& TermFits::products(Block& a, Block& b) {
  std::vector<Eigen::MatrixXd>& out = a.with_block[&b];
  if (out.empty())
    for (const auto& s : sums_.sessions)
      out.emplace_back(a.white.middleRows(s.begin, s.end - s.begin).transpose() *
                       b.white.middleRows(s.begin, s.end - s.begin));
  return out;
}

FitResult TermFits::fit(const std::vector<Term>& causes, bool covariance) {
  std::vector<Block*> blocks{&blocks_.front()};
  for (const auto& term : causes) blocks.push_back(block_of(term));
  std::vector<Hypothesis> model;
  Eigen::Index columns = 3;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const Block& b = *blocks[i];
    Hypothesis h;
    h.term = b.term;
    h.first = columns;
    h.own = b.own;
    h.repeats = b.repeats;
    if (b.spring >= 0) h.spring = columns + b.spring;
    if (b.damper >= 0) h.damper = columns + b.damper;
    columns += b.white.cols();
    model.push_back(std::move(h));
  }
  Products& p = sums_;
  p.folds.assign(p.sessions.size(), Eigen::MatrixXd(columns, columns));
  for (auto& s : p.sessions) s.with_effects.resize(columns, k_session_effects);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    Block& a = *blocks[i];
    if (a.with_effects.empty())
      for (const auto& s : p.sessions)
        a.with_effects.emplace_back(
            a.white.middleRows(s.begin, s.end - s.begin).transpose() *
            view_.white_effects->middleRows(s.begin, s.end - s.begin).cast<double>());
    for (std::size_t s = 0; s < p.sessions.size(); ++s)
      p.sessions[s].with_effects.middleRows(row, a.white.cols()) = a.with_effects[s];
    Eigen::Index column = 0;
    for (std::size_t j = 0; j <= i; ++j) {
      Block& b = *blocks[j];
      const auto& both = products(a, b);
      for (std::size_t s = 0; s < p.sessions.size(); ++s) {
        p.folds[s].block(row, column, a.white.cols(), b.white.cols()) = both[s];
        p.folds[s].block(column, row, b.white.cols(), a.white.cols()) = both[s].transpose();
      }
      column += b.white.cols();
    }
    row += a.white.cols();
  }
  integrate(p);
  std::vector<const Hypothesis*> terms;
  for (const auto& h : model) terms.push_back(&h);
  FitResult out = explain::fit(p, terms, -1, covariance);
  while (blocks_.size() > 1 + std::max(k_kept, causes.size())) {
    for (auto& b : blocks_) b.with_block.erase(&blocks_.back());
    blocks_.pop_back();
  }
  return out;
}

}  // namespace cavum::explain
