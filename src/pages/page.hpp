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

namespace pmg::pages {

enum class Tone { kGood, kBad, kNeutral };

/// Each call appends to the page. The page escapes all text.
class Page {
 public:
  explicit Page(std::string title);

  void verdict(Tone tone, const std::string& text);  ///< one highlighted line
  void heading(const std::string& text);             ///< begins a section, which the list at the top names
  void paragraph(const std::string& text);
  void table(const Table& table);
  void chart(const Chart& chart);  ///< throws std::invalid_argument if a line's x decreases or y has another size
  void lanes(const Lanes& lanes);
  void bars(const Bars& bars);
  void histogram(const Histogram& histogram);
  void plot(const Plot& plot);  ///< throws std::invalid_argument as svg(Plot) does

  void columns(const std::function<void()>& fill);  ///< pictures side by side if the window is wide enough
  void folded(const std::string& summary, const std::function<void()>& fill);  ///< shown after a click

  std::string html() const;
  void write(const std::filesystem::path& file) const;  ///< throws std::runtime_error

 private:
  void picture(const std::string& title, const std::string& content);
  void show_x(const std::string& axis, double x);

  std::string title_, body_, contents_;
  int headings_ = 0;
  bool needs_script_ = false;          ///< for charts and lanes
  std::map<std::string, Range> axes_;  ///< range of each axis when the page opens
};

}  // namespace pmg::pages
