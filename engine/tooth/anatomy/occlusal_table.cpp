#include "engine/tooth/anatomy/occlusal_table.h"

#include <algorithm>
#include <array>
#include <queue>
#include <utility>

namespace cavum {
namespace {

constexpr int k_unknown = 0, k_outside = 1, k_inside = 2;
constexpr double k_min_table_mm2 = 2.0;
/// Eight neighbours, counter-clockwise from +x.
constexpr std::array<std::array<int, 2>, 8> k_ring{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

std::size_t index_of_cell(int cell) { return static_cast<std::size_t>(cell); }

/// Labels of all cells by flooding from the marked ones, lowest places first.
void flood(const HeightMap& map, std::vector<int>& label) {
  using Entry = std::pair<std::pair<double, int>, int>;  // level, turn; cell
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  int turn = 0;
  for (int c = 0; c < map.count(); ++c)
    if (label[index_of_cell(c)] != k_unknown) front.push({{map.at(c), turn++}, c});
  while (!front.empty()) {
    const auto [level, c] = front.top();
    front.pop();
    const int x = c % map.nx, y = c / map.nx;
    for (std::size_t k = 0; k < 8; k += 2) {
      const int nx = x + k_ring[k][0], ny = y + k_ring[k][1];
      if (!map.is_on(nx, ny)) continue;
      const int n = map.index(nx, ny);
      if (label[index_of_cell(n)] != k_unknown) continue;
      label[index_of_cell(n)] = label[index_of_cell(c)];
      front.push({{std::max(level.first, map.at(n)), turn++}, n});
    }
  }
}

/// The largest piece (by sides) of `in`, its holes filled.
std::vector<std::uint8_t> largest_piece(const HeightMap& map, const std::vector<std::uint8_t>& in) {
  std::vector<int> piece(in.size(), -1);
  const auto spread = [&](int from, int number, std::uint8_t kind) {
    std::vector<int> stack{from};
    piece[index_of_cell(from)] = number;
    int size = 0;
    while (!stack.empty()) {
      const int c = stack.back();
      stack.pop_back();
      ++size;
      for (std::size_t k = 0; k < 8; k += 2) {
        const int nx = c % map.nx + k_ring[k][0], ny = c / map.nx + k_ring[k][1];
        if (nx < 0 || ny < 0 || nx >= map.nx || ny >= map.ny) continue;
        const int n = map.index(nx, ny);
        if (piece[index_of_cell(n)] >= 0 || in[index_of_cell(n)] != kind) continue;
        piece[index_of_cell(n)] = number;
        stack.push_back(n);
      }
    }
    return size;
  };
  int numbers = 0, best = -1, most = 0;
  for (int c = 0; c < map.count(); ++c)
    if (in[index_of_cell(c)] != 0 && piece[index_of_cell(c)] < 0)
      if (const int size = spread(c, numbers++, 1); size > most) {
        most = size;
        best = numbers - 1;
      }
  std::vector<std::uint8_t> out(in.size(), 0);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = piece[i] == best && best >= 0;
  // what is not reached from the map's border is a hole
  std::vector<std::uint8_t> seen(in.size(), 0);
  std::vector<int> stack;
  const auto enter = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= map.nx || y >= map.ny || seen[index_of_cell(map.index(x, y))] != 0 ||
        out[index_of_cell(map.index(x, y))] != 0)
      return;
    seen[index_of_cell(map.index(x, y))] = 1;
    stack.push_back(map.index(x, y));
  };
  for (int x = 0; x < map.nx; ++x) enter(x, 0), enter(x, map.ny - 1);
  for (int y = 0; y < map.ny; ++y) enter(0, y), enter(map.nx - 1, y);
  while (!stack.empty()) {
    const int c = stack.back();
    stack.pop_back();
    for (std::size_t k = 0; k < 8; k += 2)
      enter(c % map.nx + k_ring[k][0], c / map.nx + k_ring[k][1]);
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = seen[i] == 0;
  return out;
}

/// Moore's tracing of the border of a piece without holes.
std::vector<int> trace(const HeightMap& map, const std::vector<std::uint8_t>& in) {
  int start = -1;
  for (int c = 0; c < map.count() && start < 0; ++c)
    if (in[index_of_cell(c)] != 0) start = c;
  std::vector<int> edge;
  if (start < 0) return edge;
  const auto is_in = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < map.nx && y < map.ny && in[index_of_cell(map.index(x, y))] != 0;
  };
  // the start is the lowest, leftmost cell: it is entered from below
  int c = start;
  std::size_t back = 6;
  const auto most = 4 * in.size();
  for (std::size_t steps = 0; steps < most; ++steps) {
    edge.push_back(c);
    int next = -1;
    for (std::size_t k = 1; k <= 8; ++k) {
      const std::size_t dir = (back + k) % 8;
      if (!is_in(c % map.nx + k_ring[dir][0], c / map.nx + k_ring[dir][1])) continue;
      next = map.index(c % map.nx + k_ring[dir][0], c / map.nx + k_ring[dir][1]);
      back = (dir + 4) % 8;
      break;
    }
    if (next < 0 || next == start) break;
    c = next;
  }
  return edge;
}

}  // namespace

std::optional<OcclusalTable> occlusal_table(const HeightMap& map, const std::vector<int>& lowest) {
  if (lowest.empty()) return std::nullopt;
  std::vector<int> label(map.z.size(), k_unknown);
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      bool border = !map.is_on(x, y);
      for (const auto& [dx, dy] : k_ring) border = border || !map.is_on(x + dx, y + dy);
      if (border) label[index_of_cell(map.index(x, y))] = k_outside;
    }
  for (const int c : lowest) label[index_of_cell(c)] = k_inside;
  flood(map, label);
  std::vector<std::uint8_t> in(label.size(), 0);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = label[i] == k_inside;
  OcclusalTable table;
  table.inside = largest_piece(map, in);
  const auto cells = std::count(table.inside.begin(), table.inside.end(), std::uint8_t{1});
  if (static_cast<double>(cells) * HeightMap::k_cell_mm * HeightMap::k_cell_mm < k_min_table_mm2)
    return std::nullopt;
  table.edge = trace(map, table.inside);
  return table;
}

std::vector<int> valley_path(const HeightMap& map, const std::vector<std::uint8_t>& allowed,
                             const std::vector<double>& curvature, const std::vector<int>& from,
                             const std::vector<int>& to) {
  constexpr double k_floor = 0.15, k_most = 3.0;  // 1/mm
  std::vector<double> cost(map.z.size(), -1.0);
  std::vector<int> before(map.z.size(), -1);
  std::vector<std::uint8_t> done(map.z.size(), 0), goal(map.z.size(), 0);
  for (const int c : to) goal[index_of_cell(c)] = 1;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (const int c : from) {
    cost[index_of_cell(c)] = 0.0;
    front.push({0.0, c});
  }
  int end = -1;
  while (!front.empty()) {
    const int c = front.top().second;
    front.pop();
    if (done[index_of_cell(c)] != 0) continue;
    done[index_of_cell(c)] = 1;
    if (goal[index_of_cell(c)] != 0) {
      end = c;
      break;
    }
    for (std::size_t k = 0; k < 8; ++k) {
      const int nx = c % map.nx + k_ring[k][0], ny = c / map.nx + k_ring[k][1];
      if (!map.is_on(nx, ny)) continue;
      const int n = map.index(nx, ny);
      if (allowed[index_of_cell(n)] == 0 && goal[index_of_cell(n)] == 0) continue;
      const double bend = std::clamp(
          0.5 * (curvature[index_of_cell(c)] + curvature[index_of_cell(n)]), 0.0, k_most);
      const double sum =
          cost[index_of_cell(c)] + (k % 2 == 0 ? 1.0 : 1.4142135623730951) / (k_floor + bend);
      if (cost[index_of_cell(n)] >= 0 && sum >= cost[index_of_cell(n)]) continue;
      cost[index_of_cell(n)] = sum;
      before[index_of_cell(n)] = c;
      front.push({sum, n});
    }
  }
  std::vector<int> way;
  for (int c = end; c >= 0; c = before[index_of_cell(c)]) way.push_back(c);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace cavum
