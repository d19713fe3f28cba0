#include "stages/mesh/dart_graph.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "common/geometry/samples/samples.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {
namespace {

/// Applies random operations to a graph, each where its precondition holds.
class RandomEditor {
 public:
  RandomEditor(DartGraph& graph, Index nodes, std::uint64_t seed)
      : graph_(graph), nodes_(nodes), random_(seed) {}

  /// \return what was done; empty where the place drawn allows nothing
  std::string edit() {
    const Index dart = random_dart();
    switch (random_() % 5) {
      case 0:
        return connect(dart);
      case 1:
        return split(dart);
      case 2:
        return remove(dart);
      case 3:
        return dissolve(dart);
      default:
        return contract(dart);
    }
  }

 private:
  Index random_dart() {
    for (;;) {
      const auto d = static_cast<Index>(random_() % graph_.dart_count());
      if (graph_.is_alive(d)) return d;
    }
  }

  std::string connect(Index a) {
    Index b = a;
    for (auto steps = 1 + random_() % 6; steps > 0; --steps) b = graph_.next(b);
    if (a == b) return "";
    const Index from = graph_.from(a);
    const Index to = graph_.from(b);
    const Index dart = graph_.connect(a, b);
    EXPECT_EQ(graph_.from(dart), from);
    EXPECT_EQ(graph_.to(dart), to);
    EXPECT_EQ(graph_.next(dart), b);
    EXPECT_EQ(graph_.next(DartGraph::opposite(dart)), a);
    return "connect";
  }

  std::string split(Index dart) {
    const Index from = graph_.from(dart);
    const Index to = graph_.to(dart);
    const Index node = nodes_++;
    const Index second = graph_.split_edge(dart, node);
    EXPECT_EQ(graph_.from(dart), from);
    EXPECT_EQ(graph_.to(dart), node);
    EXPECT_EQ(graph_.from(second), node);
    EXPECT_EQ(graph_.to(second), to);
    EXPECT_EQ(graph_.next(dart), second);
    EXPECT_EQ(darts_around(graph_, second).size(), 2);
    return "split";
  }

  [[nodiscard]] bool same_cell(Index a, Index b) const {
    Index d = a;
    do {
      if (d == b) return true;
      d = graph_.next(d);
    } while (d != a);
    return false;
  }

  [[nodiscard]] std::size_t degree(Index dart) const { return darts_around(graph_, dart).size(); }

  std::string remove(Index dart) {
    const Index other = DartGraph::opposite(dart);
    const bool dangles = degree(dart) == 1 || degree(other) == 1;
    if (count(graph_).edges == 1) return "";  // would leave nothing
    if (same_cell(dart, other) && !dangles) return "";
    graph_.remove_edge(dart);
    EXPECT_FALSE(graph_.is_alive(dart));
    return "remove";
  }

  std::string dissolve(Index dart) {
    if (degree(dart) != 2 || graph_.prev(dart) == dart) return "";
    const Index kept = graph_.prev(dart);
    if (DartGraph::edge_of(kept) == DartGraph::edge_of(dart)) return "";
    const Index from = graph_.from(kept);
    const Index to = graph_.to(dart);
    graph_.dissolve_node(dart);
    EXPECT_EQ(graph_.from(kept), from);
    EXPECT_EQ(graph_.to(kept), to);
    return "dissolve";
  }

  std::string contract(Index dart) {
    const Index other = DartGraph::opposite(dart);
    if (graph_.from(dart) == graph_.to(dart) || degree(dart) == 1 || degree(other) == 1) return "";
    const std::size_t together = degree(dart) + degree(other) - 2;
    const Index kept = graph_.to(dart);
    const Index beside = graph_.rotate_ccw(dart);
    graph_.contract(dart);
    EXPECT_EQ(graph_.from(beside), kept);
    EXPECT_EQ(degree(beside), together);
    return "contract";
  }

  DartGraph& graph_;
  Index nodes_;
  std::mt19937_64 random_;
};

class DartGraphEdits : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(Surfaces, DartGraphEdits,
                         ::testing::Values(SampleKind::sphere, SampleKind::torus,
                                           SampleKind::open_cylinder),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(DartGraphEdits, KeepLinksAndTheEulerCharacteristic) {
  SampleOptions options;
  options.faces = 500;
  const TriMesh mesh = support::plain_tri_mesh(make_sample(GetParam(), options));
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Overlay overlay = overlay_of(mesh);
    DartGraph& graph = overlay.graph;
    ASSERT_EQ(count(graph).euler(), closed_euler(mesh));
    RandomEditor editor(graph, mesh.vertex_count(), seed);
    std::map<std::string, int> done;
    for (int i = 0; i < 1500; ++i) {
      const std::string what = editor.edit();
      if (what.empty()) continue;
      ++done[what];
      ASSERT_TRUE(is_consistent(graph)) << "after " << what << ", edit " << i;
      const GraphCounts counts = count(graph);
      ASSERT_EQ(counts.euler(), closed_euler(mesh)) << "after " << what << ", edit " << i;
      ASSERT_EQ(counts.parts, 1) << "after " << what << ", edit " << i;
    }
    for (const char* what : {"connect", "split", "remove", "dissolve", "contract"}) {
      EXPECT_GT(done[what], 10) << what;
    }
  }
}

}  // namespace
}  // namespace strake
