// The pictures of a page, as plain data. The page reads the spans when it adds a picture, and does not keep them.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "work/worth.hpp"

namespace pmg::pages {

/// Okabe and Ito's colours on a light ground; colour-blind readers can distinguish them.
namespace colour {
inline constexpr const char* kInk = "#1b1f24";
inline constexpr const char* kGrey = "#8a929c";
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kVermillion = "#d55e00";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kOrange = "#e69f00";
inline constexpr const char* kSky = "#56b4e9";
inline constexpr const char* kPurple = "#cc79a7";
}  // namespace colour

struct Line {
  std::string name;
  std::span<const double> x, y;  ///< x doesn't decrease; NaN in y is a gap; lines that share x's memory share its text
  std::string colour = colour::kBlue;
  double width_px = 1.3;
  bool dashed = false;
  bool stepped = false;  ///< holds its value until the next point
  /// Values beyond don't widen the axis of y: where they leave the picture, words at its edge say how far they go.
  double widens_from = -std::numeric_limits<double>::infinity(), widens_to = std::numeric_limits<double>::infinity();
};

/// A shaded stretch of x behind the lines.
struct Band {
  double from, to;
  std::string colour;
  std::string name = {};  ///< in the legend of a Plot, once for all bands of this name; "" leaves it out
};

/// A vertical line with a word.
struct Mark {
  double x;
  std::string text;
};

struct Chart {
  std::string title;  ///< with the unit of y: "left knee, torque [Nm]"
  std::string x_name = "time", x_unit = "s";
  std::vector<Line> lines;
  std::vector<Band> bands = {};
  std::vector<Mark> marks = {};
  int height_px = 230;
  double longest_gap =
      std::numeric_limits<double>::infinity();  ///< of x; a longer gap between points interrupts the line
  /// Charts with the same axis share range, cursor and zoom. Empty: charts with the same x_name and x_unit share one.
  std::string axis = {};
};

/// Rows of coloured stretches over x: states over time. They share the axis of charts of the same quantity.
struct Lanes {
  struct Stretch {
    double from, to;
    std::string text;
    std::string colour;
  };
  struct Lane {
    std::string name;
    std::vector<Stretch> stretches;
  };
  std::string title;
  std::string x_name = "time", x_unit = "s";
  std::vector<Lane> lanes;
  std::vector<Mark> marks = {};
};

/// The confidence interval of a value.
struct Interval {
  double lower, upper;
};

/// Horizontal bars from zero to either side; names.size() rows with one bar for each set.
struct Bars {
  struct Set {
    std::string name;
    std::vector<double> values;
    std::string colour = colour::kBlue;
    std::vector<Interval> intervals =
        {};  ///< whiskers, one for each value; the picture leaves out those that aren't finite
  };
  std::string title;
  std::string unit;
  std::vector<std::string> names;
  std::vector<Set> sets;
  std::vector<Mark> marks = {};  ///< lines across all bars, as for limits
};

struct Histogram {
  struct Set {
    std::string name;
    std::span<const double> values;
    std::string colour = colour::kBlue;
    double each = 1.0;                                          ///< values that each of these stands for
    double largest = std::numeric_limits<double>::quiet_NaN();  ///< of all, told where not all are here
  };
  std::string title;
  std::string unit;
  std::vector<Set> sets;
};

/// One line of a Plot.
struct PlotLine {
  std::string name;              ///< "" leaves it out of the legend
  std::span<const double> x, y;  ///< NaN in y is a gap
  std::string colour = colour::kBlue;
  std::vector<Interval> intervals = {};  ///< one for each value, or none
  double width_px = 1.4;
  bool dashed = false;
  bool stepped = false;
  bool points = false;  ///< a dot at each value
  bool joined = true;   ///< a line between them
};

/// Lines over any quantity. Each picture has its own axes.
struct Plot {
  std::string title;   ///< with the unit of y
  std::string x_name;  ///< with its unit
  std::vector<PlotLine> lines;
  std::vector<Band> bands = {};
  std::vector<Mark> marks = {};
  bool logarithmic_x = false, logarithmic_y = false;
  bool show_zero = false;  ///< y = 0 is in the picture, with a line
  int height_px = 170;
};

/// One stick figure, y up from the ground, in one unit of length.
struct StickFigure {
  struct Bone {
    double from_x, from_y, to_x, to_y;
    std::string colour = colour::kInk;
  };
  std::vector<Bone> bones;
};

/// Rows of stick figures, each row one name and one figure a column. Every cell has the same scale, its middle at x =
/// 0.
struct Figures {
  struct Row {
    std::string name;
    std::vector<StickFigure> figures;
  };
  std::string title;
  std::vector<std::string> columns;  ///< words below the last row
  std::vector<Row> rows;
};

/// Stick figures beside each other that move, over and over. The figures of one row have the same bones.
struct MovingFigures {
  std::string title;
  std::vector<Figures::Row> rows;  ///< of each the figures in the order of time, at equal steps over period_s
  double period_s = 1.0;
};

/// A value against its limit, in words.
struct Judgement {
  std::string what, measured, limit;
  work::Grade grade = work::Grade::kHolds;
  std::string word = {};  ///< in place of the grade's
};

struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

}  // namespace pmg::pages
