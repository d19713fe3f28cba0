#include "strake/run/slurm_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace strake {
namespace {

constexpr double kMiB = 1048576;
/// Nodes differ in speed, and a step may have to wait for another run that makes the same.
constexpr double kTimeMargin = 3;
constexpr std::int64_t kLeastMinutes = 10;
constexpr std::int64_t kLeastMiB = 256;

/// The least power of two times `least` that is not below the need: a few sizes, so that models of
/// about one size share an array.
std::int64_t size_class(double need, std::int64_t least) {
  std::int64_t size = least;
  while (static_cast<double>(size) < need) size *= 2;
  return size;
}

/// The array that the order would be alone: no name and no tasks yet.
SlurmArray array_for(const StepOrder& order, const std::set<std::size_t>& after) {
  SlurmArray array;
  array.rule = order.rule;
  array.after.assign(after.begin(), after.end());
  array.threads = std::max<std::int64_t>(1, order.threads);
  array.memory_mib = size_class(static_cast<double>(order.memory) / kMiB, kLeastMiB);
  array.minutes = size_class(kTimeMargin * order.seconds / 60, kLeastMinutes);
  return array;
}

bool are_alike(const SlurmArray& a, const SlurmArray& b) {
  return a.rule == b.rule && a.after == b.after && a.threads == b.threads &&
         a.memory_mib == b.memory_mib && a.minutes == b.minutes;
}

/// Whether tasks of models this far apart in the file may be in one array.
bool is_same_block(const SlurmArray& array, const std::vector<StepOrder>& orders,
                   std::size_t model_index) {
  const std::size_t position = array.tasks.begin()->second;
  return orders[position].model_index / kMostTasks == model_index / kMostTasks;
}

}  // namespace

std::vector<SlurmArray> slurm_arrays(const std::vector<StepOrder>& orders) {
  std::vector<SlurmArray> arrays;
  std::map<std::string, std::size_t> array_of;  // by id of the step
  for (std::size_t position = 0; position < orders.size(); ++position) {
    const StepOrder& order = orders[position];
    std::set<std::size_t> after;
    for (const std::string& id : ids_before(order)) after.insert(array_of.at(id));
    SlurmArray alone = array_for(order, after);
    const std::size_t index = order.model_index % kMostTasks;
    // A model's second step of a rule finds its index taken, and goes to a second array.
    auto found = std::find_if(arrays.begin(), arrays.end(), [&](const SlurmArray& array) {
      return are_alike(array, alone) && array.tasks.count(index) == 0 &&
             is_same_block(array, orders, order.model_index);
    });
    if (found == arrays.end()) {
      alone.name = fmt::format("{:02}-{}", arrays.size() + 1, order.rule);
      found = arrays.insert(arrays.end(), std::move(alone));
    }
    found->tasks[index] = position;
    array_of[order.id] = static_cast<std::size_t>(found - arrays.begin());
  }
  return arrays;
}

}  // namespace strake
