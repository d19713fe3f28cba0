#include "stages/restrict/restrict.h"

#include <gtest/gtest.h>

#include <memory>

#include "common/core/error.h"
#include "stages/restrict/stage.h"
#include "tests/support/chain.h"
#include "tests/unit/coarsen/coarse_samples.h"

namespace strake {
namespace {

using coarsen_test::coarsened;

support::Prepared prepared(std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return support::prepare(make_sample(SampleKind::part, options));
}

TEST(RestrictField, IsTheFieldOfTheParentAtEveryWedge) {
  const support::Prepared fine = prepared(9000);
  const TriMesh coarse = coarsened(fine.mesh, 1500);
  const PrincipalField field = restrict_field(coarse, fine.field);
  EXPECT_EQ(field.mesh_id, coarse.id);
  EXPECT_EQ(field.cross_extended, fine.field.cross_extended);
  ASSERT_EQ(field.normal.size(), coarse.wedge_vertex.size());
  ASSERT_EQ(field.face_confidence.size(), coarse.faces.size());
  for (Index w = 0; w < coarse.wedge_count(); ++w) {
    const Index parent = coarse.parent_wedge[w];
    EXPECT_EQ(field.normal[w], fine.field.normal[parent]);
    EXPECT_EQ(field.t_min[w], fine.field.t_min[parent]);
    EXPECT_EQ(field.cross[w], fine.field.cross[parent]);
    EXPECT_EQ(field.k_min[w], fine.field.k_min[parent]);
    EXPECT_EQ(field.k_max[w], fine.field.k_max[parent]);
    EXPECT_EQ(field.wedge_confidence[w], fine.field.wedge_confidence[parent]);
  }
  for (Index f = 0; f < coarse.face_count(); ++f) {
    const auto& [a, b, c] = coarse.face_wedges[f];
    const auto& confidence = field.wedge_confidence;
    EXPECT_DOUBLE_EQ(field.face_confidence[f], (confidence[a] + confidence[b] + confidence[c]) / 3);
  }
}

TEST(RestrictField, RefusesGuides) {
  const support::Prepared fine = prepared(8000);
  const TriMesh coarse = coarsened(fine.mesh, 1500);
  PrincipalField field = fine.field;
  field.guides.offsets = {0, 1};
  field.guides.face = {0};
  EXPECT_THROW(restrict_field(coarse, field), UsageError);
}

Inputs inputs_of(const TriMesh& mesh, const PrincipalField& field) {
  Inputs inputs;
  inputs.add("mesh", {std::make_shared<Value>(mesh), "coarse.hdf"});
  inputs.add("field", {std::make_shared<Value>(field), "field.hdf"});
  return inputs;
}

TEST(RestrictStage, RefusesWhatDoesNotBelongTogether) {
  const support::Prepared fine = prepared(8000);
  const TriMesh coarse = coarsened(fine.mesh, 1500);
  SilentObserver observer;
  Inputs right = inputs_of(coarse, fine.field);
  EXPECT_NO_THROW(run_stage(restrict_stage(), right, observer));
  Inputs no_parent = inputs_of(fine.mesh, fine.field);
  EXPECT_THROW(run_stage(restrict_stage(), no_parent, observer), PreconditionError);
  PrincipalField other = fine.field;
  other.mesh_id = coarse.id;
  Inputs other_parent = inputs_of(coarse, other);
  EXPECT_THROW(run_stage(restrict_stage(), other_parent, observer), PreconditionError);
  TriMesh damaged = coarse;
  damaged.parent_wedge[0] = fine.mesh.wedge_count();
  Inputs out_of_range = inputs_of(damaged, fine.field);
  EXPECT_THROW(run_stage(restrict_stage(), out_of_range, observer), InputError);
}

}  // namespace
}  // namespace strake
