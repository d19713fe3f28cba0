#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

#include "common/stage/stage.h"

namespace strake::python {

/// A value of the pipeline as an object of Python.
struct Held {
  std::shared_ptr<Value> value;
};

/// The same, of a kind that is known: what its class in Python wraps.
template <class T>
struct HeldAs : Held {
  [[nodiscard]] const T& get() const { return std::get<T>(*value); }
};

/// The object of the right class for a value.
pybind11::object held(std::shared_ptr<Value> value);
template <class T>
pybind11::object hold(T value) {
  return held(std::make_shared<Value>(std::move(value)));
}

/// Adds the classes of values and the functions that make some of them from arrays.
void add_values(pybind11::module_& module);

/// A report as a dict by dotted key.
pybind11::dict report_dict(const Report& report);

}  // namespace strake::python
