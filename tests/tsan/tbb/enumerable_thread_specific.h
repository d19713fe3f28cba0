#pragma once

// See parallel_for.h beside this file.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

namespace tbb {

/// One value for each thread that asks, made when it first does.
template <class T>
class enumerable_thread_specific {
 public:
  template <class Make>
  explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}

  T& local() {
    std::unique_ptr<T>* place = nullptr;
    {
      const std::lock_guard lock(guard_);
      place = &values_[std::this_thread::get_id()];
    }
    if (!*place) *place = std::make_unique<T>(make_());
    return **place;
  }

 private:
  std::function<T()> make_;
  std::mutex guard_;
  std::map<std::thread::id, std::unique_ptr<T>> values_;
};

}  // namespace tbb
