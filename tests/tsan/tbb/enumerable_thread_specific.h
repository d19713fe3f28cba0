#pragma once

// See parallel_for.h beside this file.

#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

namespace tbb {

/// One value for each thread that asks, made when it first does. They are gone through one by one
/// when no thread asks any more.
template <class T>
class enumerable_thread_specific {
 public:
  template <class Make>
  explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}

  T& local() {
    {
      const std::lock_guard lock(guard_);
      const auto found = of_thread_.find(std::this_thread::get_id());
      if (found != of_thread_.end()) return *found->second;
    }
    T made = make_();
    const std::lock_guard lock(guard_);
    values_.push_back(std::move(made));
    of_thread_[std::this_thread::get_id()] = &values_.back();
    return values_.back();
  }

  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }

 private:
  std::function<T()> make_;
  std::mutex guard_;
  std::list<T> values_;
  std::map<std::thread::id, T*> of_thread_;
};

}  // namespace tbb
