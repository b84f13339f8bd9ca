#pragma once
// A folder of a test's own, gone when the test ends.

#include "files/temporary_folder.h"

namespace palpa::test {

using files::TemporaryFolder;

}  // namespace palpa::test
