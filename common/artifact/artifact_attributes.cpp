#include "common/artifact/artifact_attributes.h"

#include <sstream>

namespace strake {
namespace {

constexpr const char* kColour = "colour";
constexpr const char* kTexture = "texture";
constexpr const char* kLabelNames = "label_names";
constexpr const char* kMaterialFiles = "material_files";

std::string label_dataset(std::size_t i) { return "label_" + std::to_string(i); }

std::vector<std::uint8_t> text_of_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return {text.begin(), text.end()};
}

std::vector<std::string> lines_of(const std::vector<std::uint8_t>& text) {
  std::vector<std::string> lines;
  std::istringstream stream(std::string(text.begin(), text.end()));
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// One line for each kind of labels: its name and those of the labels, between tabs.
std::vector<std::uint8_t> label_text(const std::vector<FaceLabels>& labels) {
  std::vector<std::string> lines;
  for (const FaceLabels& one : labels) {
    std::string& line = lines.emplace_back(one.name);
    for (const std::string& name : one.names) line += '\t' + name;
  }
  return text_of_lines(lines);
}

std::vector<FaceLabels> parse_labels(const std::vector<std::uint8_t>& text) {
  std::vector<FaceLabels> labels;
  for (const std::string& line : lines_of(text)) {
    FaceLabels& one = labels.emplace_back();
    std::size_t at = line.find('\t');
    one.name = line.substr(0, at);
    while (at != std::string::npos) {
      const std::size_t end = line.find('\t', at + 1);
      one.names.push_back(line.substr(at + 1, end == std::string::npos ? end : end - at - 1));
      at = end;
    }
  }
  return labels;
}

}  // namespace

void write_attributes(const Attributes& attributes, ArtifactWriter& file) {
  if (!attributes.colour.empty()) {
    file.own(kColour, attributes.colour);
    file.show(kColour, "PointData/colour");
  }
  if (!attributes.texture.empty()) file.own(kTexture, attributes.texture);
  if (attributes.labels.empty()) return;
  file.own(kLabelNames, label_text(attributes.labels));
  if (!attributes.material_files.empty()) {
    file.own(kMaterialFiles, text_of_lines(attributes.material_files));
  }
  for (std::size_t i = 0; i < attributes.labels.size(); ++i) {
    file.own(label_dataset(i), attributes.labels[i].of_face);
    file.show(label_dataset(i), "CellData/" + label_dataset(i));
  }
}

Attributes read_attributes(const ArtifactReader& file, std::size_t vertices, std::size_t corners,
                           std::size_t faces) {
  Attributes attributes;
  if (file.has(kColour)) {
    attributes.colour = file.own<Colour>(kColour);
    file.require_rows(attributes.colour, vertices, kColour);
    file.require_finite(attributes.colour, kColour);
  }
  if (file.has(kTexture)) {
    attributes.texture = file.own<TexturePoint>(kTexture);
    file.require_rows(attributes.texture, corners, kTexture);
    file.require_finite(attributes.texture, kTexture);
  }
  if (!file.has(kLabelNames)) return attributes;
  attributes.labels = parse_labels(file.own<std::uint8_t>(kLabelNames));
  if (file.has(kMaterialFiles)) {
    attributes.material_files = lines_of(file.own<std::uint8_t>(kMaterialFiles));
  }
  for (std::size_t i = 0; i < attributes.labels.size(); ++i) {
    FaceLabels& labels = attributes.labels[i];
    labels.of_face = file.own<Index>(label_dataset(i));
    file.require_rows(labels.of_face, faces, label_dataset(i));
    if (!labels.names.empty()) {
      file.require_indices(labels.of_face, 0, labels.names.size(), label_dataset(i));
    }
  }
  return attributes;
}

}  // namespace strake
