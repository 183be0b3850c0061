// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <penumbra/base/error.hpp>

namespace penumbra::test {

/// The message of the InputError that `call` throws; empty if it throws none.
template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace penumbra::test
