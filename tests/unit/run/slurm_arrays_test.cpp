#include "strake/run/slurm_arrays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "common/core/error.h"
#include "strake/run/slurm_options.h"

namespace strake {
namespace {

/// A step of a model that needs other steps of it.
StepOrder step(std::size_t model, const std::string& rule, const std::string& variant,
               const std::vector<std::string>& needs) {
  StepOrder order;
  order.model_index = model;
  order.rule = rule;
  order.id = std::to_string(model) + "." + rule + variant;
  order.memory = 100'000'000;
  order.seconds = 30;
  for (const std::string& need : needs) {
    OrderedInput input;
    input.from = std::to_string(model) + "." + need;
    order.inputs.push_back(input);
  }
  return order;
}

/// A chain whose tensor is made in parts, with three variants behind it.
std::vector<StepOrder> steps_of(std::size_t model) {
  std::vector<StepOrder> orders = {
      step(model, "import", "", {}), step(model, "tensor-1of2", "", {"import"}),
      step(model, "tensor-2of2", "", {"import"}), step(model, "tensor", "", {"import"})};
  orders.back().parts = {orders[1].inputs[0], orders[1].inputs[0]};
  orders.back().parts[0].from = orders[1].id;
  orders.back().parts[1].from = orders[2].id;
  for (const std::string variant : {".a", ".b", ".c"}) {
    orders.push_back(step(model, "trace", variant, {"import", "tensor"}));
    orders.push_back(step(model, "mesh", variant, {"import", "trace" + variant}));
  }
  return orders;
}

std::vector<StepOrder> steps_of_models(std::size_t models) {
  std::vector<StepOrder> orders;
  for (std::size_t model = 0; model < models; ++model) {
    const std::vector<StepOrder> more = steps_of(model);
    orders.insert(orders.end(), more.begin(), more.end());
  }
  return orders;
}

/// What makes submission right: with dependencies between tasks of equal index alone, every step
/// waits for all it needs, and for steps of its own model only.
void expect_sound(const std::vector<StepOrder>& orders, const std::vector<SlurmArray>& arrays) {
  struct Place {
    std::size_t array;
    std::size_t index;
  };
  std::map<std::string, Place> place_of;
  std::set<std::string> names;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    EXPECT_TRUE(names.insert(arrays[a].name).second) << arrays[a].name;
    for (const auto& [index, position] : arrays[a].tasks) {
      const StepOrder& order = orders[position];
      EXPECT_LT(index, kMostTasks);
      EXPECT_EQ(order.rule, arrays[a].rule);
      EXPECT_GE(arrays[a].memory_mib * 1048576, order.memory) << order.id;
      EXPECT_GT(static_cast<double>(arrays[a].minutes) * 60, order.seconds) << order.id;
      EXPECT_GE(arrays[a].threads, order.threads) << order.id;
      EXPECT_TRUE(place_of.emplace(order.id, Place{a, index}).second) << order.id;
    }
  }
  ASSERT_EQ(place_of.size(), orders.size());
  for (const StepOrder& order : orders) {
    const Place place = place_of.at(order.id);
    std::set<std::size_t> needed;
    for (const std::string& id : ids_before(order)) {
      EXPECT_EQ(place_of.at(id).index, place.index) << order.id << " needs " << id;
      needed.insert(place_of.at(id).array);
    }
    const std::vector<std::size_t>& after = arrays[place.array].after;
    EXPECT_EQ(std::set<std::size_t>(after.begin(), after.end()), needed) << order.id;
    for (const std::size_t earlier : after) EXPECT_LT(earlier, place.array);
  }
}

TEST(SlurmArrays, NothingNeedsNoArray) { EXPECT_TRUE(slurm_arrays({}).empty()); }

TEST(SlurmArrays, ModelsOfOneSizeShareAllArrays) {
  const std::vector<StepOrder> orders = steps_of_models(6);
  const std::vector<SlurmArray> arrays = slurm_arrays(orders);
  expect_sound(orders, arrays);
  EXPECT_EQ(arrays.size(), steps_of(0).size());
  for (const SlurmArray& array : arrays) EXPECT_EQ(array.tasks.size(), 6u);
}

TEST(SlurmArrays, PartsAreBeforeTheirWhole) {
  const std::vector<StepOrder> orders = steps_of_models(2);
  const std::vector<SlurmArray> arrays = slurm_arrays(orders);
  const auto whole = std::find_if(arrays.begin(), arrays.end(),
                                  [](const SlurmArray& array) { return array.rule == "tensor"; });
  ASSERT_NE(whole, arrays.end());
  std::set<std::string> before;
  for (const std::size_t earlier : whole->after) before.insert(arrays[earlier].rule);
  EXPECT_EQ(before, (std::set<std::string>{"import", "tensor-1of2", "tensor-2of2"}));
}

TEST(SlurmArrays, AHugeModelDoesNotMakeOthersAskForAsMuch) {
  std::vector<StepOrder> orders = steps_of_models(3);
  const std::vector<SlurmArray> small = slurm_arrays(orders);
  for (StepOrder& order : orders) {
    if (order.model_index != 1) continue;
    order.memory *= 100;
  }
  const std::vector<SlurmArray> arrays = slurm_arrays(orders);
  expect_sound(orders, arrays);
  for (const SlurmArray& array : arrays) {
    const bool is_huge = array.tasks.count(1) != 0;
    EXPECT_EQ(array.tasks.size(), is_huge ? 1u : 2u);
    if (is_huge) continue;
    EXPECT_EQ(array.memory_mib, small.front().memory_mib);
  }
}

TEST(SlurmArrays, ASlowModelGetsItsTime) {
  std::vector<StepOrder> orders = steps_of_models(2);
  for (StepOrder& order : orders) {
    if (order.model_index == 1) order.seconds *= 1000;
  }
  expect_sound(orders, slurm_arrays(orders));
}

TEST(SlurmArrays, AnEndlessModelGetsSomeTime) {
  std::vector<StepOrder> orders = steps_of_models(1);
  orders[0].seconds = 1e18;
  expect_sound(orders, slurm_arrays(orders));
}

TEST(SlurmArrays, WhatIsInTheStoreIsNotWaitedFor) {
  std::vector<StepOrder> orders = steps_of_models(4);
  // Import and tensors of model 2 are in the store.
  const auto is_there = [](const StepOrder& order) {
    return order.model_index == 2 && order.rule != "trace" && order.rule != "mesh";
  };
  orders.erase(std::remove_if(orders.begin(), orders.end(), is_there), orders.end());
  for (StepOrder& order : orders) {
    if (order.model_index != 2) continue;
    for (OrderedInput& input : order.inputs) {
      if (input.from == "2.import" || input.from == "2.tensor") input.from.clear();
    }
  }
  expect_sound(orders, slurm_arrays(orders));
}

TEST(SlurmArrays, IndicesStayBelowTheLimitForAnyNumberOfModels) {
  std::vector<StepOrder> orders;
  for (std::size_t model = 0; model < 2 * kMostTasks + 1; ++model) {
    orders.push_back(step(model, "import", "", {}));
    orders.push_back(step(model, "tensor", "", {"import"}));
  }
  expect_sound(orders, slurm_arrays(orders));
}

TEST(SlurmArrays, ThreadsAreAskedFor) {
  std::vector<StepOrder> orders = steps_of(0);
  orders[0].threads = 8;
  EXPECT_EQ(slurm_arrays(orders).front().threads, 8);
}

TEST(SlurmOptions, AreTakenAsTheyStand) {
  for (const char* text : {"--partition=long --account=geometry", "-p long", "--comment=\"a b\"",
                           "--wait-all-nodes=1", "--open-mode=append"}) {
    EXPECT_EQ(checked_sbatch_options(text, {}), text);
  }
}

TEST(SlurmOptions, ThoseThatTheRunHangsOnAreRefusedWithTheirPlace) {
  const Place place{"pipeline.yaml", 7, 3};
  for (const char* text :
       {"", "long", "--mem=1G\nrm", "--array=1-3", "--nice --dependency=singleton", "-a1",
        "--chdir /tmp", "-D /tmp", "--arr=7", "--depend=singleton", "--ou=x"}) {
    try {
      checked_sbatch_options(text, place);
      ADD_FAILURE() << text;
    } catch (const UsageError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("pipeline.yaml:7:3: ", 0), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace strake
