#include "src/report/numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace trackbed {
namespace {

TEST(Rounded, KeepsSixDigits) {
  EXPECT_EQ(Rounded(138.30922701029215), 138.309);
  EXPECT_EQ(Rounded(-0.037026741709416965), -0.0370267);
  EXPECT_EQ(Rounded(2.0 / 3.0 * 1e7), 6666670.0);
  EXPECT_EQ(Rounded(47.1), 47.1);
  // Negligible values become zero, without a sign.
  EXPECT_EQ(Rounded(4.9e-7), 0.0);
  EXPECT_FALSE(std::signbit(Rounded(-4.9e-7)));
  EXPECT_EQ(Rounded(5.12345678e-7), 5.12346e-7);
}

TEST(RoundedColumn, TakesTheRowsAskedFor) {
  Table table({"t_s", "x_m"});
  for (int i = 0; i < 5; ++i) {
    table.AddRow({0.1 * i, 1.0 / 3.0 + i});
  }
  EXPECT_EQ(RoundedColumn(table, "x_m", {0, 3}).dump(), "[0.333333,3.33333]");
}

/// Three sinusoids with different periods over time; the second one has a peak in a single row.
Table Waves(std::size_t rows) {
  Table table({"t_s", "a", "b", "c"});
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 0.02 * static_cast<double>(i);
    table.AddRow({t, std::sin(t), i == rows / 3 ? 9.0 : std::cos(3.0 * t), std::sin(40.0 * t)});
  }
  return table;
}

TEST(RowsToShow, AreAllOfAShortTable) {
  const Table table = Waves(400);
  const std::vector<std::size_t> rows = RowsToShow(table, 400);
  ASSERT_EQ(rows.size(), 400U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i], i);
  }
  EXPECT_TRUE(RowsToShow(Table({"t_s"}), 10).empty());
}

TEST(RowsToShow, KeepEveryExtremeOfALongOne) {
  const Table table = Waves(30000);
  for (const std::size_t limit : {5000U, 100U, 20U, 3U}) {
    const std::vector<std::size_t> rows = RowsToShow(table, limit);
    // The minimum is two rows for each of four columns, and the two end rows.
    EXPECT_LE(rows.size(), std::max<std::size_t>(limit, 10));
    EXPECT_EQ(rows.front(), 0U);
    EXPECT_EQ(rows.back(), 29999U);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end()), rows.end());
    for (const char* column : {"a", "b", "c"}) {
      const std::vector<double> all = table.Column(column);
      std::vector<double> kept;
      for (const std::size_t row : rows) {
        kept.push_back(all[row]);
      }
      EXPECT_EQ(*std::max_element(kept.begin(), kept.end()),
                *std::max_element(all.begin(), all.end()));
      EXPECT_EQ(*std::min_element(kept.begin(), kept.end()),
                *std::min_element(all.begin(), all.end()));
    }
  }
}

TEST(RowsToShow, LeaveNoLongGap) {
  const Table table = Waves(30000);
  const std::vector<std::size_t> rows = RowsToShow(table, 1026);
  // Each of 128 intervals keeps at most two rows for each of four columns, 1024 rows in all, and
  // 1026 with the two end rows. An interval has at most 235 rows, so adjacent kept rows are less
  // than two intervals apart.
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_LT(rows[i] - rows[i - 1], 470U);
  }
}

}  // namespace
}  // namespace trackbed
