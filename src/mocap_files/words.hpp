// The text of a motion file, word by word, with line numbers for errors.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pmg::mocap {

/// A number as motion files write it, a leading + included. Returns false if the word is no finite number.
bool to_number(std::string_view word, double& value);

/// A word for an error message: short, and nothing that a terminal would obey.
std::string shown_word(std::string_view word);

/// Upper and lower case are the same.
bool same_word(std::string_view a, std::string_view b);

/// Words are separated by blanks, tabs and line ends. Every error is a ConfigError with file and line.
class Words {
 public:
  Words(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  bool end();                                          ///< nothing but blanks is left
  std::string_view peek();                             ///< empty at the end
  std::string_view next(const std::string& expected);  ///< throws at the end
  void expect(std::string_view word);                  ///< takes this word, in any case, or throws
  double number(const std::string& expected);
  /// A whole number in [lower, upper].
  long whole(const std::string& expected, long lower, long upper);
  /// The rest of the line, without blanks at both ends.
  std::string_view rest_of_line();
  int line() const { return word_line_; }  ///< of the word that was taken last

  [[noreturn]] void fail(const std::string& wrong, const std::string& expected) const;

 private:
  void skip_blanks();

  std::string file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, word_line_ = 1;
};

}  // namespace pmg::mocap
