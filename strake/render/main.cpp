// Draws a polygon mesh into a PNG file, without a display.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/core/error.h"
#include "common/core/number_text.h"
#include "common/core/text.h"
#include "common/stage/build_facts.h"
#include "common/stage/console.h"
#include "common/stage/program.h"
#include "common/stage/value.h"
#include "strake/render/camera.h"
#include "strake/render/draw.h"
#include "strake/render/image.h"
#include "strake/render/line_file.h"
#include "strake/render/scene.h"
#include "strake/render/shown_run.h"

namespace strake {
namespace {

struct Arguments {
  std::string mesh;
  std::string output;
  std::string lines;
  std::string size = "1200x900";
  std::string target;
  std::string up = "y";
  std::string view_address;
  std::string section;
  std::string layers = "edges";
  std::string colour;  ///< "": that of the surface
  RunView shown;
  double line_width = 2.5;
  bool flat = false;
  View view;
  DrawOptions draw;
};

/// As CLI::Range, which takes "nan".
CLI::Validator number_from(double least, double most) {
  const std::string range = fmt::format("{} to {}", least, most);
  return CLI::Validator(
      [=](const std::string& text) {
        const std::optional<double> value = parse_number(text);
        const bool is_inside = value && *value >= least && *value <= most;
        return is_inside ? std::string() : fmt::format("'{}' is no number from {}", text, range);
      },
      "FLOAT in " + range);
}

void add_arguments(CLI::App& app, Arguments& arguments) {
  app.add_option(
         "mesh", arguments.mesh,
         "Mesh file: OBJ, PLY, OFF or STL; or a run: a folder that strake remesh --keep made")
      ->type_name("FILE")
      ->required();
  app.add_option("-o,--output", arguments.output, "PNG file to write")
      ->type_name("FILE.png")
      ->required();
  app.add_option("--size", arguments.size, "Picture size in pixels, WIDTHxHEIGHT")
      ->capture_default_str();
  app.add_option("--azimuth", arguments.view.azimuth_deg, "Viewer's turn around the up axis, deg")
      ->check(number_from(-360, 360))
      ->capture_default_str();
  app.add_option("--elevation", arguments.view.elevation_deg, "Viewer above the horizon, deg")
      ->check(number_from(-90, 90))
      ->capture_default_str();
  app.add_option("--zoom", arguments.view.zoom, "Magnification; 1 shows the whole model")
      ->check(number_from(1e-3, 1e6))
      ->capture_default_str();
  app.add_option("--target", arguments.target,
                 "Point in the middle of the picture, X,Y,Z in model units (default: the model's)");
  app.add_option("--up", arguments.up, "Up axis")
      ->check(CLI::IsMember({"y", "z"}))
      ->capture_default_str();
  app.add_flag("--edges", arguments.draw.edges, "Draw the edges of the polygons");
  app.add_option("--edge-width", arguments.draw.edge_width, "Width of the edges, pixels")
      ->check(number_from(0.1, 50))
      ->capture_default_str();
  app.add_option("--lines", arguments.lines,
                 "OBJ file with 'l' polylines to draw on the surface: group min blue, max red")
      ->type_name("FILE.obj");
  app.add_option("--line-width", arguments.line_width, "Width of the polylines, pixels")
      ->check(number_from(0.1, 50))
      ->capture_default_str();
  app.add_flag("--flat", arguments.flat, "One normal per face, no smooth shading");
  app.add_option("--samples", arguments.draw.samples, "Rays per pixel and axis")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
}

/// What of a run is shown; options of their own go before those in the address of a view.
void add_run_arguments(CLI::App& app, Arguments& arguments) {
  CLI::App* group = app.add_option_group("Of a run");
  group->add_option("--surface", arguments.shown.surface, "input or result")->capture_default_str();
  group
      ->add_option("--colour", arguments.colour,
                   "of the input: plain, k_min, k_max, confidence, colours; of the result: sides, "
                   "distance, alignment, colours, labels, plain")
      ->default_str("the first of them");
  group
      ->add_option(
          "--layers", arguments.layers,
          "none, or joined by +: edges, triangles, minimum, maximum, boundary, feature, ends, "
          "seeds, principal, cross, guides")
      ->capture_default_str();
  group
      ->add_option("--section", arguments.section,
                   "Plane that cuts: x, y or z, and a share of the size: y,0.5")
      ->type_name("AXIS,PLACE");
  group
      ->add_option("--view", arguments.view_address,
                   "All of that and the camera from the address of a view in the run's report")
      ->type_name("ADDRESS")
      ->excludes("--surface", "--colour", "--layers", "--section");
}

/// \throw UsageError  where the picture would take the place of what is drawn, or of another model
/// \throw InputError  where it cannot be written
void check_output(const Arguments& arguments) {
  const std::filesystem::path output = arguments.output;
  if (lower_case(output.extension().string()) != ".png") {
    throw UsageError("output '" + arguments.output + "' is no PNG file; give a name with .png");
  }
  check_files({{"input", arguments.mesh}, {"input 'lines'", arguments.lines}}, arguments.output,
              "");
  check_place("output", output);
}

void interpret(Arguments& arguments) {
  check_output(arguments);
  char rest = 0;
  DrawOptions& size = arguments.draw;
  constexpr int kLargest = 16384;
  if (std::sscanf(arguments.size.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2 ||
      size.width < 1 || size.height < 1 || size.width > kLargest || size.height > kLargest) {
    throw UsageError("--size '" + arguments.size + "': expected WIDTHxHEIGHT, each 1 to 16384");
  }
  if (!arguments.view_address.empty()) {
    arguments.shown = read_view(arguments.view_address);
  } else {
    const std::string first = arguments.shown.surface == "input" ? "plain" : "sides";
    const std::string colour = arguments.colour.empty() ? first : arguments.colour;
    std::string address = "#a=0," + arguments.shown.surface + "," + colour + "," + colour + "," +
                          (arguments.layers == "none" ? "" : arguments.layers);
    if (!arguments.section.empty()) address += "&section=" + arguments.section;
    arguments.shown = read_view(address);
  }
  arguments.view.z_up = arguments.up == "z";
  if (arguments.target.empty()) return;
  Vec3 p;
  if (std::sscanf(arguments.target.c_str(), "%lf,%lf,%lf%c", &p.x(), &p.y(), &p.z(), &rest) != 3 ||
      !p.allFinite()) {
    throw UsageError("--target '" + arguments.target + "': expected three numbers, X,Y,Z");
  }
  arguments.view.target = p;
}

/// Groups of lines, which are added to the scene.
std::vector<std::string> add_lines(const Polylines& lines, double radius, Scene& scene) {
  std::vector<std::string> groups;
  for (const Polylines::Line& line : lines.lines) groups.push_back(line.group);
  if (!groups.empty()) scene.add_lines(lines, radius);
  return groups;
}

Camera camera_on(const Scene& scene, const View& view, const DrawOptions& picture) {
  std::vector<Vec3> used;
  for (const Index v : scene.mesh().corners) used.push_back(scene.mesh().positions[v]);
  return Camera(used, view, picture.width, picture.height);
}

/// \param place  in the scene's frame, in which the model's diagonal is 1
void check_near(const Vec3& place, const char* what) {
  constexpr double kFarthest = 1e6;  // beyond it rays lose their digits
  if (place.cwiseAbs().maxCoeff() <= kFarthest) return;
  throw UsageError(
      fmt::format("{} is more than {} diagonals away from the model", what, kFarthest));
}

/// The view from the command line, in the scene's frame.
View view_in(const Scene& scene, View view) {
  if (!view.target) return view;
  view.target = scene.place(*view.target);
  check_near(*view.target, "--target");
  return view;
}

constexpr double kReportFieldOfView = 32;  // of viewer/src/stage.js

void draw_run(const Arguments& arguments) {
  ShownRun shown = show_run(report::read_run(arguments.mesh), arguments.shown);
  DrawOptions picture = arguments.draw;
  picture.face_colours = std::move(shown.face_colours);
  picture.section = arguments.shown.section;
  picture.edges = shown.has_edges;
  Scene scene(std::move(shown.mesh), arguments.mesh, arguments.flat, shown.frame);
  const auto& from = arguments.shown.camera;
  if (from) {
    check_near(from->first, "the view's camera");
    check_near(from->second, "what the view looks at");
  }
  const Camera camera =
      from ? Camera(from->first, from->second, kReportFieldOfView, picture.width, picture.height)
           : camera_on(scene, view_in(scene, arguments.view), picture);
  const double radius = arguments.line_width / 2 * camera.pixel_size(Vec3::Zero());
  const std::vector<std::string> groups = add_lines(shown.lines, radius, scene);
  scene.commit();
  write_png(draw(scene, camera, groups, picture), arguments.output);
}

void draw_file(const Arguments& arguments) {
  ReadReport read;
  PolyMesh mesh = read_mesh(arguments.mesh, read);
  for (const std::string& warning : read.warnings()) {
    write_stderr("strake-render: " + warning + "\n");
  }
  Scene scene(std::move(mesh), arguments.mesh, arguments.flat);
  const View view = view_in(scene, arguments.view);
  const Camera camera = camera_on(scene, view, arguments.draw);
  const double radius =
      arguments.line_width / 2 * camera.pixel_size(view.target.value_or(Vec3::Zero()));
  const Polylines lines = arguments.lines.empty() ? Polylines{} : read_polylines(arguments.lines);
  const std::vector<std::string> groups = add_lines(lines, radius, scene);
  scene.commit();
  write_png(draw(scene, camera, groups, arguments.draw), arguments.output);
}

void run(Arguments arguments) {
  interpret(arguments);
  std::error_code ignored;
  if (std::filesystem::is_directory(arguments.mesh, ignored)) {
    draw_run(arguments);
  } else {
    draw_file(arguments);
  }
}

}  // namespace
}  // namespace strake

int main(int argc, char** argv) {
  return strake::run_guarded("strake-render", strake::LogFormat::text, [&] {
    CLI::App app("Draws a polygon mesh into a PNG file.", "strake-render");
    app.set_version_flag("--version", strake::version_text("strake-render"));
    strake::Arguments arguments;
    strake::add_arguments(app, arguments);
    strake::add_run_arguments(app, arguments);
    app.footer(
        "Examples:\n"
        "  strake-render quads.obj -o quads.png --edges\n"
        "  strake-render work -o curvature.png --surface input --colour k_max --layers "
        "minimum+maximum\n"
        "  strake-render scan.ply -o scan.png --azimuth 60 --zoom 2 --size 800x600");
    if (const auto exit_code = strake::parse_command_line(app, argc, argv)) return *exit_code;
    strake::run(std::move(arguments));
    return 0;
  });
}
