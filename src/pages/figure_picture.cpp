#include "pages/figure_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>

#include "pages/axis.hpp"
#include "pages/svg_parts.hpp"
#include "pages/text.hpp"

namespace pmg::pages {

namespace {

constexpr int kNameHeight = 18, kColumnsHeight = 20;
constexpr double kCellMargin = 0.06;   // of a cell, on each side of the widest figure
constexpr double kWidestCell = 200.0;  // so that one figure alone doesn't fill the page
constexpr double kBone = 2.6;

/// The cells' common scale.
class Scale {
 public:
  Scale(const std::vector<Figures::Row>& rows, std::size_t columns) {
    Range x{0.0, 0.0}, y{0.0, 0.0};
    for (const Figures::Row& row : rows) {
      for (const StickFigure& figure : row.figures) {
        for (const StickFigure::Bone& bone : figure.bones) {
          x.include(bone.from_x), x.include(bone.to_x);
          y.include(bone.from_y), y.include(bone.to_y);
        }
      }
    }
    const double half = std::max({-x.from, x.to, 1e-9});
    cell_ = std::min(kWidestCell,
                     static_cast<double>(kPictureWidth) / static_cast<double>(std::max<std::size_t>(columns, 1)));
    per_unit_ = cell_ * (0.5 - kCellMargin) / half;
    height_ = per_unit_ * y.span();
    ground_ = per_unit_ * y.to;
  }
  double cell() const { return cell_; }
  double height() const { return height_; }
  double ground() const { return ground_; }  ///< below a row's top
  double x(std::size_t column, double of) const { return cell_ * (static_cast<double>(column) + 0.5) + per_unit_ * of; }
  double y(double top, double of) const { return top + ground_ - per_unit_ * of; }

 private:
  double cell_ = 0.0, per_unit_ = 1.0, height_ = 0.0, ground_ = 0.0;
};

std::string begin(double height, const std::string& title) {
  return fmt::format(R"(<svg viewBox="0 0 {0} {1:.0f}" style="max-width:{0}px" role="img" aria-label="{2}">)",
                     kPictureWidth, height, escape_markup(title));
}

bool drawable(const StickFigure::Bone& bone) {
  return can_be_shown(bone.from_x) && can_be_shown(bone.from_y) && can_be_shown(bone.to_x) && can_be_shown(bone.to_y);
}

std::string ground_line(double from, double to, double y) {
  return fmt::format(R"(<path class="ground" d="M{:.1f} {:.1f}H{:.1f}" stroke="{}"/>)", from, y, to, colour::kGrey);
}

}  // namespace

std::string svg(const Figures& figures) {
  std::size_t columns = figures.columns.size();
  for (const Figures::Row& row : figures.rows) columns = std::max(columns, row.figures.size());
  const Scale scale(figures.rows, columns);
  const double row_height = kNameHeight + scale.height() + 8.0;
  std::string out = begin(row_height * static_cast<double>(figures.rows.size()) + kColumnsHeight, figures.title);
  double top = kNameHeight;
  for (const Figures::Row& row : figures.rows) {
    fmt::format_to(std::back_inserter(out), R"(<text class="row" x="2" y="{:.1f}">{}</text>)", top - 5.0,
                   escape_markup(row.name));
    out += ground_line(0.0, scale.cell() * static_cast<double>(columns), scale.y(top, 0.0));
    for (std::size_t i = 0; i < row.figures.size(); ++i) {
      for (const StickFigure::Bone& bone : row.figures[i].bones) {
        if (!drawable(bone)) continue;
        fmt::format_to(
            std::back_inserter(out),
            R"(<path class="bone" d="M{:.1f} {:.1f}L{:.1f} {:.1f}" stroke="{}" stroke-width="{}" stroke-linecap="round"/>)",
            scale.x(i, bone.from_x), scale.y(top, bone.from_y), scale.x(i, bone.to_x), scale.y(top, bone.to_y),
            escape_markup(bone.colour), kBone);
      }
    }
    top += row_height;
  }
  for (std::size_t i = 0; i < figures.columns.size(); ++i) {
    fmt::format_to(std::back_inserter(out), R"(<text class="tick" x="{:.1f}" y="{:.1f}">{}</text>)", scale.x(i, 0.0),
                   top - kNameHeight + 14.0, escape_markup(fitted(figures.columns[i], scale.cell())));
  }
  return out + "</svg>";
}

std::string svg(const MovingFigures& figures) {
  const Scale scale(figures.rows, figures.rows.size());
  std::string out = begin(kNameHeight + scale.height() + 8.0, figures.title);
  for (std::size_t i = 0; i < figures.rows.size(); ++i) {
    const Figures::Row& row = figures.rows[i];
    if (row.figures.empty()) throw std::invalid_argument("moving figures need one figure a row at least");
    const std::size_t bones = row.figures.front().bones.size();
    for (const StickFigure& figure : row.figures) {
      if (figure.bones.size() != bones) throw std::invalid_argument("a moving figure's bones must stay the same");
    }
    fmt::format_to(std::back_inserter(out), R"(<text class="tick" x="{:.1f}" y="13">{}</text>)", scale.x(i, 0.0),
                   escape_markup(fitted(row.name, scale.cell())));
    out += ground_line(scale.cell() * static_cast<double>(i), scale.cell() * static_cast<double>(i + 1),
                       scale.y(kNameHeight, 0.0));
    for (std::size_t b = 0; b < bones; ++b) {
      if (!std::ranges::all_of(row.figures, [b](const StickFigure& f) { return drawable(f.bones[b]); })) continue;
      const StickFigure::Bone& first = row.figures.front().bones[b];
      fmt::format_to(std::back_inserter(out),
                     R"(<line class="bone" stroke="{}" stroke-width="{}" stroke-linecap="round")",
                     escape_markup(first.colour), kBone);
      const std::array<std::pair<const char*, double StickFigure::Bone::*>, 4> ends = {
          std::pair{"x1", &StickFigure::Bone::from_x}, std::pair{"y1", &StickFigure::Bone::from_y},
          std::pair{"x2", &StickFigure::Bone::to_x}, std::pair{"y2", &StickFigure::Bone::to_y}};
      const auto place = [&](const char* name, double value) {
        return name[0] == 'x' ? scale.x(i, value) : scale.y(kNameHeight, value);
      };
      for (const auto& [name, end] : ends)
        fmt::format_to(std::back_inserter(out), R"( {}="{:.1f}")", name, place(name, first.*end));
      out += ">";
      for (const auto& [name, end] : ends) {
        fmt::format_to(std::back_inserter(out),
                       R"(<animate attributeName="{}" dur="{:.3f}s" repeatCount="indefinite" values=")", name,
                       figures.period_s);
        for (const StickFigure& figure : row.figures)
          fmt::format_to(std::back_inserter(out), "{:.1f};", place(name, figure.bones[b].*end));
        fmt::format_to(std::back_inserter(out), R"({:.1f}"/>)", place(name, first.*end));
      }
      out += "</line>";
    }
  }
  return out + "</svg>";
}

}  // namespace pmg::pages
