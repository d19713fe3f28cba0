#pragma once

#include <fast_float/fast_float.h>

#include <charconv>
#include <cstdint>
#include <limits>
#include <string_view>

namespace strake::meshfile {

/// Walks over text line by line and word by word, without copying. Lines end with LF, CR or CRLF.
class TextScanner {
 public:
  /// \param comment  character that hides the rest of its line; 0 for none
  explicit TextScanner(std::string_view text, char comment = 0)
      : at_(text.data()), end_(text.data() + text.size()), comment_(comment) {}

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] const char* position() const { return at_; }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }

  /// Skips blanks and continued line ends ("\" before a line end).
  /// \return whether a word follows on this line
  bool skip_blanks() {
    while (at_ != end_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (*at_ == '\\' && at_ + 1 != end_ && is_line_end(at_[1])) {
        at_ += at_[1] == '\r' && at_ + 2 != end_ && at_[2] == '\n' ? 3 : 2;
      } else {
        return !is_line_end(*at_) && *at_ != comment_;
      }
    }
    return false;
  }

  /// Skips blanks, comments and line ends. \return whether a word follows
  bool skip_space() {
    while (!skip_blanks()) {
      if (at_end()) return false;
      next_line();
    }
    return true;
  }

  void next_line() {
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    if (at_ != end_) at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1;
  }

  /// The next word on this line; empty at its end.
  std::string_view word() {
    if (!skip_blanks()) return {};
    const char* first = at_;
    skip_word();
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  /// \pre not at the end of a word
  void skip_character() { ++at_; }
  void skip_word() {
    while (!ends_word(at_)) ++at_;
  }

  /// Reads the next word of this line as a number; NaN where it is none.
  /// \return whether there was a word
  bool number(double& value) {
    value = std::numeric_limits<double>::quiet_NaN();
    if (!skip_blanks()) return false;
    const char* first = *at_ == '+' ? at_ + 1 : at_;
    double parsed = 0;
    const auto result = fast_float::from_chars(first, end_, parsed);
    if (ends_word(result.ptr)) {
      if (result.ptr != first) value = parsed;
      at_ = result.ptr;
    } else {
      skip_word();
    }
    return true;
  }

  /// Reads an integer at the present position, without skipping blanks.
  /// \return false where there is none or it does not fit; a number that does not fit is consumed
  bool integer(std::int64_t& value) {
    const char* first = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto result = std::from_chars(first, end_, value);
    at_ = result.ptr;
    return result.ec == std::errc();
  }

  [[nodiscard]] bool at_word_end() const { return ends_word(at_); }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }

 private:
  [[nodiscard]] bool ends_word(const char* at) const {
    return at == end_ || is_blank(*at) || is_line_end(*at) ||
           (*at == '\\' && at + 1 != end_ && is_line_end(at[1]));
  }

  const char* at_;
  const char* end_;
  char comment_;
};

}  // namespace strake::meshfile
