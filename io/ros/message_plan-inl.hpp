// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <io/ros/wire_types-inl.hpp>

namespace penumbra::io {

struct PlanStep;

/// How a message is read by a definition: field by field, in the definition's order.
struct MessagePlan {
  const std::vector<TypeDefinition>* types = nullptr;
  std::vector<PlanStep> steps;
};

struct PlanStep {
  const FieldDefinition* field = nullptr;
  int member = -1;            ///< index into Fields<M>::members; -1: the field is stepped over
  std::size_t min_bytes = 1;  ///< of each value
  MessagePlan nested;         ///< of a message that is a member
};

/// Makes plans, and keeps what the definition lacks.
class PlanMaker {
 public:
  explicit PlanMaker(const std::vector<TypeDefinition>& types) : types_(types) {}

  template <typename M>
  [[nodiscard]] MessagePlan plan(std::size_t type, const std::string& path) {
    constexpr std::size_t count = std::tuple_size_v<decltype(Fields<M>::members)>;
    MessagePlan result{&types_, {}};
    std::array<bool, count> found{};
    for (const FieldDefinition& field : types_[type].fields) {
      PlanStep step{&field, -1, min_bytes_each(field, types_), {}};
      for_each_member<M>([&](int index, const auto& member) {
        if (member.name != field.name) return;
        found[static_cast<std::size_t>(index)] = true;
        step.member = index;
        bind(member, path + field.name, step);
      });
      result.steps.push_back(std::move(step));
    }
    for_each_member<M>([&](int index, const auto& member) {
      if (!found[static_cast<std::size_t>(index)])
        faults_.push_back("lacks " + path + std::string(member.name));
    });
    return result;
  }

  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }

 private:
  template <typename M, typename F>
  static void for_each_member(const F& call) {
    std::apply(
        [&](const auto&... members) {
          int index = 0;
          (call(index++, members), ...);
        },
        Fields<M>::members);
  }

  template <typename M, typename T>
  void bind(const Member<M, T>&, const std::string& path, PlanStep& step) {
    bind_as<T>(path, step);
  }

  template <typename W, typename M, typename T>
  void bind(const Converted<W, M, T>&, const std::string& path, PlanStep& step) {
    bind_as<W>(path, step);
  }

  template <typename T>
  void bind_as(const std::string& path, PlanStep& step) {
    using Value = typename Shape<T>::Value;
    if (!has_shape<T>(*step.field))
      faults_.push_back("has " + path + " as " + type_text(*step.field) + ", not " +
                        shape_text<T>());
    else if constexpr (WireMessage<Value>)
      step.nested = plan<Value>(step.field->nested, path + ".");
  }

  const std::vector<TypeDefinition>& types_;
  std::vector<std::string> faults_;
};

}  // namespace penumbra::io
