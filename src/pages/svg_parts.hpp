// The shared parts of inline SVG pictures.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pmg::pages {

inline constexpr int kPictureWidth = 640;  ///< of all pictures, so that those below each other line up
inline constexpr int kTop = 8;             ///< above a plot
inline constexpr int kAxisHeight = 38;     ///< below it: labels, and the axis's name under them

/// Upper estimate of a text's width in the pictures' font, in the picture's units.
double text_width(const std::string& text);

/// The text, or its beginning with an ellipsis if it doesn't fit; not escaped.
std::string fitted(const std::string& text, double width);

/// Coloured squares with names, in as many rows as they need.
class Legend {
 public:
  Legend(double left, double right) : left_(left), right_(right), at_(left) {}

  /// dashed: the square has a gap, as the line it stands for.
  void add(const std::string& colour, const std::string& text, bool dashed = false);
  int height() const;
  std::string svg(double top) const;

 private:
  struct Entry {
    double x;
    int row;
    std::string colour, text;
    bool dashed;
  };
  double left_, right_, at_;
  std::vector<Entry> entries_;
};

}  // namespace pmg::pages
