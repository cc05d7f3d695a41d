// What a suite counts, and the page that has it.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace backlight::test {

struct Count {
  int rays = 0, hits = 0, missed = 0, invented = 0, unresolved = 0, within_rounding = 0;
  double worst = 0.0;  ///< of resolved hits: off the true point, times the cosine of incidence, of the size
};

/// Rows: the cells of the row's name, with " | " between them, and the counts.
using Table = std::vector<std::pair<std::string, Count>>;

/// Compares the table with the one behind the line `<!-- NAME -->` of docs/stability.md, or puts it there
/// when BACKLIGHT_UPDATE_STABILITY is set. `columns` are the headings of a row's name.
void expect_on_page(const std::string& name, const std::string& columns, const Table& table);

}  // namespace backlight::test
