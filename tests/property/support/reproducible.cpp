// RapidCheck draws the same cases on every run unless the environment's RC_PARAMS says otherwise,
// for example RC_PARAMS="seed=7 max_success=1000".
#include <cstdlib>

namespace {

[[maybe_unused]] const int kParamsSet = setenv("RC_PARAMS", "seed=20070604 max_success=25", 0);

}  // namespace
