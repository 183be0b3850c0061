// SPDX-License-Identifier: Apache-2.0
#include <python/bindings.hpp>
#include <python/fields.hpp>

#include <penumbra/base/error.hpp>
#include <penumbra/time/joint_buffer.hpp>

namespace penumbra::python {
namespace {

void bind_joint_answers(py::module_& m) {
  py::class_<JointBufferOptions> options(m, "JointBufferOptions", "How joint states are merged.");
  using O = JointBufferOptions;
  bind_fields(
      options,
      Field{"max_gap", &O::max_gap,
            "Seconds between two states of a joint that may be interpolated."},
      Field{"history", &O::history, "Seconds of states that are kept behind the newest."},
      Field{"max_states", &O::max_states, "Of each variable; the oldest are dropped beyond."},
      Field{"compare_sources", &O::compare_sources,
            "Several publishers of one joint are compared; else only the believed one counts."});

  py::class_<JointGap> gap(m, "JointGap",
                           "A variable that has no position at the stamp asked for.");
  show_fields(
      gap, Field{"variable", &JointGap::variable, "Index into Robot.variables."},
      Field{"why", &JointGap::why, "missing: never seen; stale: no state near the stamp."},
      Field{"last_seen", &JointGap::last_seen,
            "Stamp of its latest state at or before, nanoseconds, or None."},
      Field{"next_seen", &JointGap::next_seen, "Stamp of its first state after it, or None."},
      Field{"is_refused", &JointGap::is_refused,
            "Never seen, but for values that are not finite or too large."},
      Field{"jump", &JointGap::jump,
            "Rad or m between two states next to the stamp, more than the joint can move."},
      Field{"source", &JointGap::source, "The publisher that is believed, if there are several."});

  py::class_<JointDispute> dispute(m, "JointDispute",
                                   "A variable for which two publishers differ near a stamp.");
  show_fields(dispute, Field{"variable", &JointDispute::variable, "Index into Robot.variables."},
              Field{"stamp", &JointDispute::stamp, "Of the values, nanoseconds."},
              Field{"sources", &JointDispute::sources,
                    "As given to insert(): the believed one, another one."},
              Field{"values", &JointDispute::values, "What each of them published, rad and m."});

  py::class_<JointAnswer> answer(m, "JointAnswer", "Where the joints are at a stamp.");
  using A = JointAnswer;
  show_fields(
      answer,
      Field{"status", &A::status, "missing before stale before disputed, where several occur."},
      Field{"positions", &A::positions,
            "In the order of Robot.variables, rad and m; valid only if status is ok or "
            "disputed."},
      Field{"age", &A::age, "Nanoseconds from the stamp to the farthest used state."},
      Field{"gaps", &A::gaps, "Empty if status is ok or disputed."},
      Field{"disputes", &A::disputes, "Empty if status is ok."},
      Field{"other_names", &A::other_names,
            "Names in the states that are no joints of the robot, if a variable is missing."});
}

}  // namespace

void bind_joint_buffer(py::module_& m) {
  bind_joint_answers(m);
  py::class_<JointBuffer>(
      m, "JointBuffer",
      "Merges joint states, complete or partial, in any order, and interpolates them to a stamp. "
      "Never extrapolates: what is not between two states is answered stale.")
      .def(py::init<const Robot&, JointBufferOptions>(), py::arg("robot"),
           py::arg("options") = JointBufferOptions())
      .def(
          "insert",
          [](JointBuffer& self, Nanoseconds<std::int64_t> stamp,
             const std::vector<std::string>& names, const Numbers& positions,
             const std::string& source) {
            if (names.size() != positions.size())
              throw InputError(std::to_string(positions.size()) + " positions for " +
                               std::to_string(names.size()) + " names; expected as many");
            return self.insert(stamp, names, positions, source);
          },
          py::arg("stamp"), py::arg("names"), py::arg("positions"), py::arg("source") = "",
          "Adds one joint state; stamp in nanoseconds, positions in rad and m. Returns the number "
          "of values taken; names that are no variable are ignored. source: a name for the "
          "publisher, the same for all of its states.")
      .def(
          "at",
          [](const JointBuffer& self, Nanoseconds<std::int64_t> stamp) {
            JointAnswer answer;
            self.at(stamp, answer);
            return answer;
          },
          py::arg("stamp"), "Positions at a stamp, nanoseconds.")
      .def("complete_until", &JointBuffer::complete_until,
           "Stamp of the newest state up to which every joint is known, nanoseconds; else None.")
      .def("clear", &JointBuffer::clear, "Forgets every state.")
      .def_property_readonly("refused_values", &JointBuffer::refused_values,
                             "Positions of the robot's joints that insert() did not take.");
}

}  // namespace penumbra::python
