// One self-contained HTML page, pictures first. It needs no network; its tables, bars, histograms and plots need no
// script either. Charts over the same axis share range, cursor and zoom.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pages/axis.hpp"
#include "pages/pictures.hpp"
#include "work/worth.hpp"

namespace pmg::pages {

/// A page may be drawn anew over an older one, over nothing else. Throws std::invalid_argument if this file is there
/// and is none.
void expect_page_or_none(const std::filesystem::path& file);

/// Each call appends to the page. The page escapes all text.
class Page {
 public:
  explicit Page(std::string title);

  /// What the whole page is worth: a highlighted line with its reservations, if there are any. From then on no verdict
  /// is of a better colour, whatever it says of its own part.
  void worth(const work::Worth& worth);
  /// One highlighted line of the colour of what it is worth: green only if it holds. Reservations stand before the
  /// text.
  void verdict(const work::Worth& worth, const std::string& text);
  void note(const std::string& text);     ///< one highlighted line that judges nothing
  void heading(const std::string& text);  ///< begins a section, which the list at the top names
  void paragraph(const std::string& text);
  void table(const Table& table);
  /// A table of these; the last column has each one's own grade as a word of its colour.
  void judgements(const std::vector<Judgement>& judgements);
  void chart(const Chart& chart);  ///< throws std::invalid_argument if a line's x decreases or y has another size
  void lanes(const Lanes& lanes);
  void bars(const Bars& bars);
  void histogram(const Histogram& histogram);
  void plot(const Plot& plot);  ///< throws std::invalid_argument as svg(Plot) does
  void figures(const Figures& figures);
  void figures(const MovingFigures& figures);  ///< throws std::invalid_argument as svg(MovingFigures) does

  void columns(const std::function<void()>& fill);  ///< pictures side by side if the window is wide enough
  void folded(const std::string& summary, const std::function<void()>& fill);  ///< shown after a click

  std::string html() const;
  /// Throws std::runtime_error, and what expect_page_or_none() does.
  void write(const std::filesystem::path& file) const;

 private:
  void picture(const std::string& title, const std::string& content);
  void show_x(const std::string& axis, double x);

  void highlighted(work::Grade grade, const std::string& text);

  std::string title_, body_, contents_;
  work::Worth worth_;
  int headings_ = 0;
  bool needs_script_ = false;          ///< for charts and lanes
  std::map<std::string, Range> axes_;  ///< range of each axis when the page opens
};

}  // namespace pmg::pages
