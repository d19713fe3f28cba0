#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace strake {

/// A length as the user wrote it: a share of the bounding-box diagonal ("0.1%") or model units
/// ("2.5").
struct Length {
  double value = 0;      ///< share (0.001 for "0.1%") or model units
  bool relative = true;  ///< whether `value` is a share of the diagonal

  /// The length in model units, for a mesh of the given bounding-box diagonal.
  [[nodiscard]] double resolve(double diagonal) const {
    return relative ? value * diagonal : value;
  }
  /// The text that `parse` reads back to an equal length: "0.1%" or "2.5".
  [[nodiscard]] std::string to_string() const;
  /// \throw UsageError where the text is not a finite number, optionally followed by '%'
  static Length parse(std::string_view text);
  friend bool operator==(const Length&, const Length&) = default;
};

inline constexpr Length percent(double share) { return {share / 100, true}; }

/// One declared option: the single source of flags, help, range checks and provenance.
struct Option {
  using Target =
      std::variant<bool*, std::int64_t*, double*, std::string*, Length*,
                   std::optional<std::int64_t>*, std::optional<double>*, std::optional<Length>*>;

  std::string name;  ///< as on the command line, without dashes: "feature-angle"
  Target target;     ///< where the value lives; holds the default until parsed
  std::string unit;  ///< "deg", "length", "" ...
  std::string help;  ///< one sentence
  /// Limits of a number; of a length they are shares. What is written in model units must be
  /// positive where `min` is not negative, and is held to them by `check_lengths`.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};  ///< of a string option; empty: any text
  bool affects_result = true;             ///< false for --threads: not part of provenance and keys
  std::string one_of = {};  ///< options of a stage with the same word here exclude each other

  /// The present value as text, in the form `parse_into` reads; "" for an empty optional.
  [[nodiscard]] std::string value() const;
  /// The present value as a number; nothing for an empty optional, and for what is no number.
  [[nodiscard]] std::optional<double> number() const;
  /// Sets the target. \throw UsageError naming the option, the text and what is allowed
  void parse_into(std::string_view text) const;
};

/// Whether it is a length, with or without a default.
bool takes_length(const Option& option);

/// A limit of an option as people write it: a share for a length, digits without exponent.
std::string limit_text(const Option& option, double limit);

using OptionList = std::vector<Option>;

/// Holds lengths in model units to their limits, which are shares of the bounding-box diagonal:
/// what cannot be judged before there is a mesh.
/// \throw UsageError naming the option, the text, the share it is, and what is allowed
void check_lengths(const OptionList& options, double diagonal);

/// Gives an option another value, until it goes out of scope, however that happens.
class OtherValue {
 public:
  /// \param option  kept by reference
  /// \throw UsageError as `Option::parse_into`
  OtherValue(const Option& option, std::string_view text) : option_(option), own_(option.value()) {
    option.parse_into(text);
  }
  OtherValue(const OtherValue&) = delete;
  OtherValue& operator=(const OtherValue&) = delete;
  ~OtherValue() { option_.parse_into(own_); }

 private:
  const Option& option_;
  std::string own_;
};

}  // namespace strake
