/// \file
/// Times of the kernels that the stages spend their time in, on one thread, on real artifacts:
///
///     strake-bench-kernels mesh.hdf field.hdf lines.hdf [RADIUS] [options of Google Benchmark]
///
/// RADIUS of the tensors' balls is a share of the diagonal, 0.01 by default.
/// The places asked about follow the lines, as in the stages; rates of places in random order are
/// those of the memory.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <vector>

#include "common/artifact/artifact.h"
#include "common/geometry/face_crossings/exact_predicates.h"
#include "common/geometry/line_chord.h"
#include "common/geometry/mesh_measures.h"
#include "stages/tensor/ball.h"
#include "stages/trace/barrier_lines.h"
#include "stages/trace/finished_lines.h"
#include "stages/trace/line_head.h"

namespace strake {
namespace {

constexpr double kStopFraction = 0.5;  ///< of the wanted distance, as `strake-trace` by default
constexpr double kStep = 0.25;         ///< line distances between places, likewise

/// The artifacts, and what tracing makes of them.
struct Data {
  TriMesh mesh;
  PrincipalField field;
  LineSet lines;
  double radius;
  Spacing spacing{lines.spacing_along_min, lines.spacing_along_max};
  TraceDomain domain{mesh, field, spacing, FaceNormals(mesh)};
  std::vector<BarrierLine> barriers = barrier_lines(domain);
  std::vector<std::uint8_t> flags = barrier_flags(mesh, barriers);
  FaceBlocks blocks{mesh, spacing, flags};
  ProximityIndex index{blocks, flags};
  std::vector<LineSegment> chords;  ///< of all lines of curvature

  Data(const char* mesh_file, const char* field_file, const char* lines_file, double share)
      : mesh(read_tri_mesh(mesh_file)),
        field(read_principal_field(field_file)),
        lines(read_line_set(lines_file)),
        radius(share * mesh.diagonal) {
    for (Index line = 0; line < lines.line_count(); ++line) add(line);
  }
  Data(const Data&) = delete;  // its parts hold references to each other
  Data& operator=(const Data&) = delete;

 private:
  void add(Index line) {
    const auto first = static_cast<std::ptrdiff_t>(chords.size());
    for (Index i = lines.offsets[line]; i + 1 < lines.offsets[line + 1]; ++i) {
      LineSegment chord;
      chord.a = line_point_position(mesh, lines.points[i]);
      chord.b = line_point_position(mesh, lines.points[i + 1]);
      chord.face = lines.chord_face[i];
      chord.family = lines.chord_family[i];
      if (chord.face == kNone || chord.a == chord.b) continue;
      chord.direction = (chord.b - chord.a).normalized();
      chords.push_back(chord);
    }
    index.insert({chords.begin() + first, chords.end()}, line);
  }
};

/// Heads of lines on the chords, a step of the tracer or a little more from each other.
std::vector<LineHead> heads_along(const Data& data) {
  std::vector<LineHead> heads;
  double way = 0;
  for (const LineSegment& chord : data.chords) {
    Seed seed;
    seed.face = chord.face;
    seed.direction = chord.direction;
    const LineHead head = start_head(data.domain, seed, true);
    way += (chord.b - chord.a).norm();
    const LocalSpacing spacing = spacing_at(data.domain, head);
    if (way < kStep * std::min(spacing.to_neighbours, spacing.along)) continue;
    heads.push_back(head);
    way = 0;
  }
  return heads;
}

/// Asks for other lines within a share of the wanted distance, from where lines run.
std::vector<ProximityQuery> queries_along(const Data& data) {
  std::vector<ProximityQuery> queries;
  for (const LineHead& head : heads_along(data)) {
    ProximityQuery query;
    query.face = head.context.chart.face;
    query.point = world_point(data.domain, head.context, head.point);
    query.direction = world_direction(data.domain, head.context, head.heading);
    query.distance = kStopFraction * spacing_at(data.domain, head).to_neighbours;
    queries.push_back(query);
  }
  return queries;
}

/// Calls use(i) for one number below `count` after the other, around and around.
template <class Use>
void measure(benchmark::State& state, std::size_t count, const Use& use) {
  std::size_t i = 0;
  for ([[maybe_unused]] auto turn : state) {
    use(i);
    if (++i == count) i = 0;
  }
  state.SetItemsProcessed(state.iterations());
}

void query(benchmark::State& state, const Data* data) {
  const std::vector<ProximityQuery> queries = queries_along(*data);
  ProximityProbe probe(data->index);
  measure(state, queries.size(),
          [&](std::size_t i) { benchmark::DoNotOptimize(probe.query(queries[i])); });
}

void evaluate_field(benchmark::State& state, const Data* data) {
  const std::vector<LineHead> heads = heads_along(*data);
  measure(state, heads.size(), [&](std::size_t i) {
    const FieldContext context = field_context(data->domain, heads[i].context.chart.face);
    benchmark::DoNotOptimize(
        field_direction(data->domain, context, heads[i].point, heads[i].heading, heads[i].family));
  });
}

void chord_step(benchmark::State& state, const Data* data) {
  const std::vector<LineHead> heads = heads_along(*data);
  measure(state, heads.size(), [&](std::size_t i) {
    const LocalSpacing spacing = spacing_at(data->domain, heads[i]);
    benchmark::DoNotOptimize(runge_kutta(data->domain, heads[i],
                                         kStep * std::min(spacing.to_neighbours, spacing.along)));
  });
}

void ball_tensor(benchmark::State& state, const Data* data) {
  const std::vector<Vec3> normals = data->domain.face_normals.all();
  const FaceCycles cycles(data->mesh, normals);
  BallWalker walker(cycles);
  measure(state, static_cast<std::size_t>(data->mesh.face_count()), [&](std::size_t f) {
    benchmark::DoNotOptimize(walker.tensor(static_cast<Index>(3 * f), normals[f], {data->radius}));
  });
}

void crossing_test(benchmark::State& state, const Data* data) {
  const auto& p = data->mesh.positions;
  measure(state, static_cast<std::size_t>(data->mesh.face_count()), [&](std::size_t f) {
    const auto& [a, b, c] = data->mesh.faces[f];
    const Index other = data->mesh.twin[3 * f] == kNone
                            ? c
                            : data->mesh.from(TriMesh::prev(data->mesh.twin[3 * f]));
    benchmark::DoNotOptimize(orientation(p[a], p[b], p[c], p[other]));
  });
}

}  // namespace
}  // namespace strake

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 4 || argc > 5) {
    std::cerr << "usage: strake-bench-kernels mesh.hdf field.hdf lines.hdf [RADIUS]\n";
    return 2;
  }
  try {
    const strake::Data data(argv[1], argv[2], argv[3], argc > 4 ? std::atof(argv[4]) : 0.01);
    benchmark::RegisterBenchmark("tensor of a ball", strake::ball_tensor, &data);
    benchmark::RegisterBenchmark("field at a point", strake::evaluate_field, &data);
    benchmark::RegisterBenchmark("Runge-Kutta step", strake::chord_step, &data);
    benchmark::RegisterBenchmark("proximity query", strake::query, &data);
    benchmark::RegisterBenchmark("orientation, exact", strake::crossing_test, &data);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::cerr << "strake-bench-kernels: error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
