#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "common/core/error.h"
#include "common/core/number_text.h"
#include "strake/render/shown_run.h"

namespace strake {
namespace {

using Words = std::vector<std::string>;

const std::map<std::string, Words> kColours = {
    {"input", {"plain", "k_min", "k_max", "confidence", "colours"}},
    {"result", {"sides", "distance", "alignment", "colours", "labels", "plain"}}};
const Words kLayers = {"edges", "triangles", "minimum",   "maximum", "boundary", "feature",
                       "ends",  "seeds",     "principal", "cross",   "guides"};

Words split(const std::string& text, char mark) {
  Words words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, mark);) words.push_back(word);
  return words;
}

void check_word(const std::string& word, const Words& known, const char* what) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  throw UsageError(
      fmt::format("there is no {} '{}'; there are {}", what, word, fmt::join(known, ", ")));
}

double number(const std::string& text) {
  if (const std::optional<double> value = parse_number(text)) return *value;
  throw UsageError("view: '" + text + "' is no number");
}

Section read_section(const Words& words) {
  const bool has_axis =
      words.size() >= 2 && (words[0] == "x" || words[0] == "y" || words[0] == "z");
  const double place = has_axis ? number(words[1]) : -1;
  const bool is_flipped = words.size() == 3 && words[2] == "flipped";
  if (place < 0 || place > 1 || (words.size() > 2 && !is_flipped)) {
    throw UsageError(
        "section: expected x, y or z and a place from 0 to 1, as in y,0.5 or y,0.5,flipped");
  }
  return {words[0][0] - 'x', place - 0.5, is_flipped};
}

void read_pane(const Words& words, RunView& view) {
  if (words.size() < 4) throw UsageError("view: a pane is RUN,SURFACE,COLOUR,COLOUR,LAYERS");
  view.surface = words[1];
  view.colour = words[view.surface == "input" ? 2 : 3];
  view.layers.clear();
  if (words.size() < 5) return;
  for (const std::string& layer : split(words[4], '+')) view.layers.insert(layer);
}

}  // namespace

RunView read_view(const std::string& address) {
  RunView view;
  for (const std::string& part : split(address.substr(address.find('#') + 1), '&')) {
    const std::size_t at = part.find('=');
    const std::string name = part.substr(0, at);
    const Words words = at == std::string::npos ? Words{} : split(part.substr(at + 1), ',');
    if (name == "a") read_pane(words, view);
    if (name == "section") view.section = read_section(words);
    if (name == "camera") {
      if (words.size() != 6) throw UsageError("view: a camera has six numbers");
      Vec3 from;
      Vec3 to;
      for (int k = 0; k < 3; ++k) {
        from[k] = number(words[k]);
        to[k] = number(words[k + 3]);
      }
      view.camera = {from, to};
    }
  }
  return view;
}

void check_view(const RunView& view) {
  check_word(view.surface, {"input", "result"}, "surface");
  check_word(view.colour, kColours.at(view.surface), ("colour of the " + view.surface).c_str());
  for (const std::string& layer : view.layers) check_word(layer, kLayers, "layer");
}

}  // namespace strake
