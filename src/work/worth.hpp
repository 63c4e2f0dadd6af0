// What a result is worth: the one rule for a page's colour and first line, a file's field, a console's line and an exit
// code.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace pmg::work {

/// From the best to the worst. A result of several reservations has the worst of their grades.
enum class Grade {
  kHolds,        ///< what was promised was measured and holds
  kOpen,         ///< it holds; what its data can't tell is left open, and named
  kPartial,      ///< part of what was promised is missing
  kMissed,       ///< measured, and not as asked
  kNoBetter,     ///< no better than doing nothing
  kOffItsData,   ///< its data contradict it, or are faulty
  kInterrupted,  ///< it ended before the work did
};

/// holds, open, partial, missed, no better, off its data, interrupted: the word in files.
inline const char* name(Grade grade) {
  constexpr const char* kNames[] = {"holds", "open", "partial", "missed", "no better", "off its data", "interrupted"};
  return kNames[static_cast<int>(grade)];
}

/// Reservations against a result; without any it holds.
class Worth {
 public:
  struct Reservation {
    Grade grade;
    std::string why;  ///< a clause in words, without a full stop
  };

  Worth() = default;
  Worth(Grade grade, std::string why) { add(grade, std::move(why)); }

  /// A reservation. Grade kHolds is none.
  void add(Grade grade, std::string why) {
    if (grade == Grade::kHolds) return;
    const auto worse = [](Grade asked, const Reservation& there) { return asked > there.grade; };
    reservations_.insert(std::upper_bound(reservations_.begin(), reservations_.end(), grade, worse),
                         {grade, std::move(why)});
  }
  void add_if(bool condition, Grade grade, std::string why) {
    if (condition) add(grade, std::move(why));
  }
  void add(const Worth& other) {
    for (const Reservation& one : other.reservations_) add(one.grade, one.why);
  }

  Grade grade() const { return reservations_.empty() ? Grade::kHolds : reservations_.front().grade; }
  /// True if it can be used as it is.
  bool usable() const { return grade() <= Grade::kOpen; }
  const std::vector<Reservation>& reservations() const { return reservations_; }  ///< the worst first

  /// "INTERRUPTED: after 3 of 20 runs; OPEN: ...", the worst first; "" if it holds.
  std::string sentence() const {
    std::string text;
    for (const Reservation& one : reservations_) {
      std::string word = name(one.grade);
      std::ranges::transform(word, word.begin(), [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
      text += (text.empty() ? "" : "; ") + word + ": " + one.why;
    }
    return text;
  }

  /// Of a program: 0 where it is usable, 130 interrupted, 1 otherwise.
  int exit_code() const { return grade() == Grade::kInterrupted ? 130 : usable() ? 0 : 1; }

 private:
  std::vector<Reservation> reservations_;
};

/// (JSON object, worth) => `worth`, the grade's word, and `reservations`, each with its grade and its reason.
template <typename Json>
void add_to(Json& json, const Worth& worth) {
  json["worth"] = name(worth.grade());
  json["reservations"] = Json::array();
  for (const Worth::Reservation& one : worth.reservations())
    json["reservations"].push_back({{"worth", name(one.grade)}, {"why", one.why}});
}

}  // namespace pmg::work
