// Kuhn and Munkres with potentials: shortest augmenting paths, O(n^3).
#include "track/cheapest_assignment.hpp"

#include <cstddef>
#include <limits>

namespace flowdlo::track {
namespace {

// Rows and columns count from 1; 0 stands for "none".
class Assignment {
 public:
  explicit Assignment(const std::vector<std::vector<double>>& cost)
      : cost_(cost),
        row_price_(cost.size() + 1, 0),
        column_price_(cost.size() + 1, 0),
        row_of_(cost.size() + 1, 0) {}

  void add(std::size_t row) {
    const std::size_t size = cost_.size();
    std::vector<double> least(size + 1, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> before(size + 1, 0);
    std::vector<char> visited(size + 1, 0);
    row_of_[0] = row;
    std::size_t column = 0;
    while (row_of_[column] != 0) {
      visited[column] = 1;
      column = step(column, least, before, visited);
    }
    while (column != 0) {
      row_of_[column] = row_of_[before[column]];
      column = before[column];
    }
  }

  [[nodiscard]] std::vector<int> columns() const {
    std::vector<int> result(cost_.size(), -1);
    for (std::size_t j = 1; j <= cost_.size(); ++j) {
      result[row_of_[j] - 1] = static_cast<int>(j) - 1;
    }
    return result;
  }

 private:
  // Relaxes from `column`'s row, moves the prices, and returns the nearest column not visited.
  std::size_t step(std::size_t column, std::vector<double>& least, std::vector<std::size_t>& before,
                   const std::vector<char>& visited) {
    const std::size_t row = row_of_[column];
    double delta = std::numeric_limits<double>::infinity();
    std::size_t next = 0;
    for (std::size_t j = 1; j <= cost_.size(); ++j) {
      if (visited[j] != 0) continue;
      const double reduced = cost_[row - 1][j - 1] - row_price_[row] - column_price_[j];
      if (reduced < least[j]) {
        least[j] = reduced;
        before[j] = column;
      }
      if (least[j] < delta) {
        delta = least[j];
        next = j;
      }
    }
    for (std::size_t j = 0; j <= cost_.size(); ++j) {
      if (visited[j] != 0) {
        row_price_[row_of_[j]] += delta;
        column_price_[j] -= delta;
      } else {
        least[j] -= delta;
      }
    }
    return next;
  }

  const std::vector<std::vector<double>>& cost_;
  std::vector<double> row_price_;
  std::vector<double> column_price_;
  std::vector<std::size_t> row_of_;
};

}  // namespace

std::vector<int> cheapest_assignment(const std::vector<std::vector<double>>& cost) {
  Assignment assignment(cost);
  for (std::size_t row = 1; row <= cost.size(); ++row) assignment.add(row);
  return assignment.columns();
}

}  // namespace flowdlo::track
