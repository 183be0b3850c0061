// SPDX-License-Identifier: Apache-2.0
namespace penumbra::app {
int run_program(int argc, char** argv);
}  // namespace penumbra::app

int main(int argc, char** argv) { return penumbra::app::run_program(argc, argv); }
