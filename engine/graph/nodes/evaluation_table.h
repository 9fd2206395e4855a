#pragma once

#include "engine/data/table_file.h"
#include "engine/vocabulary/rollout.h"

namespace coppice {

/// One row about all episodes. The interval is over episodes: those of other training runs are other rows.
Table evaluation_table(const Returns& returns, int horizon, double discount);

}  // namespace coppice
