#include <gtest/gtest.h>

#include "common/stage/stage.h"

namespace strake {
namespace {

/// Inputs with one tensor field, and where its numbers lie.
struct Given {
  Given() {
    TensorField field;
    field.tensor.assign(100, {1, 2, 3, 4, 5, 6});
    value = std::make_shared<Value>(std::move(field));
    place = std::get<TensorField>(*value).tensor.data();
    inputs.add("tensor", {value, "here"});
  }

  Inputs inputs;
  std::shared_ptr<Value> value;
  const void* place = nullptr;
};

TEST(Inputs, AreTakenWithoutACopyWhereNobodyElseHoldsThem) {
  Given given;
  given.value.reset();
  EXPECT_EQ(given.inputs.take<TensorField>("tensor").tensor.data(), given.place);
}

TEST(Inputs, StayAsTheyAreForOthersWhoHoldThem) {
  Given given;
  const TensorField taken = given.inputs.take<TensorField>("tensor");
  const auto& left = std::get<TensorField>(*given.value);
  EXPECT_EQ(left.tensor.data(), given.place);
  EXPECT_EQ(left.tensor, taken.tensor);
}

}  // namespace
}  // namespace strake
