#pragma once
// A table of a renderer's answers over places and forces, for a step that costs next to nothing.
//
// Places stand on a grid over all places at which the finger's whole width, and all that is observed, lie on the
// surface; beside them the renderer answers live. Between places by cubic convolution (Keys 1981, a = -1/2: continuous slope), between
// forces linear. A linear answer needs one force, others a list F_k = F_limit (k/n)^2. Each entry holds depth and what
// is observed of the surface.
//
// The table refines itself: it halves its spacing (and doubles its forces) until its answers differ from live ones by
// no more than what is asked for, measured at the places and forces farthest from its own.

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "mechanics/operators.h"
#include "tactile/renderer.h"

namespace palpa::tactile {

struct TableOptions {
    double spacing_m = 4e-3;  // to start with
    double error = 0.005;     // of the force, as a share of the force limit
    double shape_error_m = 2e-5;
    double most_MB = 256.0;
};

struct Table {
    double first_m[2] = {0.0, 0.0};
    double spacing_m[2] = {0.0, 0.0};
    int count[2] = {0, 0};
    // Of the tissue, before stiffness_scale, ascending; the answer at 0 is 0. A linear answer has one force and goes on
    // beyond it.
    bool linear = true;
    std::vector<double> force_N;
    int observed = 0;  // values of the surface per entry
    // Per entry (x fastest, then y, then force).
    std::vector<float> depth_m;
    std::vector<float> linearity;
    std::vector<float> value_m;  // `observed` each
    double error = 0.0;          // estimated: greatest difference of the force over the force limit
    double shape_error_m = 0.0;  // estimated, at up to the force limit
    int checked = 0;             // presses that it was compared at
    bool good = false;           // both errors are as asked for; else the renderer should go on live
    bool from_cache = false;
    std::string note;  // for people: why it is not good, or could not be stored; else empty
};

// Makes a table, or reads it from `cache` (a folder; empty for none). Takes seconds to minutes; may run in a worker
// thread. Throws mechanics::Cancelled when asked to stop.
Table make_table(const Renderer& renderer, const TableOptions& options, const std::filesystem::path& cache,
                 const mechanics::Progress& progress = {});

// Finds a place in the table. Returns false beside it.
bool find_place(const Table& table, const Eigen::Vector2d& place_m, TablePlace& at);

// At that place, before stiffness_scale: the force for a depth, or NaN if the depth is beyond the last force. Sets the
// forces' part of `at`.
double table_force_N(const Table& table, double depth_m, TablePlace& at);
// The depth for a force up to the last one. Sets the forces' part of `at`.
double table_depth_m(const Table& table, double force_N, TablePlace& at);
// Linearity ratio (mechanics/linear_range.h) and observed values of the last of these answers.
double table_linearity(const Table& table, const TablePlace& at);
void table_shape_m(const Table& table, const TablePlace& at, Eigen::Ref<Eigen::VectorXd> out_m);

// A table in the making. The loop looks at ready() each step; the answer changes from null to the table once. The
// destructor cancels and waits for at most one block of presses.
class TableInProgress {
  public:
    TableInProgress(const Renderer& renderer, const TableOptions& options, std::filesystem::path cache);
    ~TableInProgress();
    TableInProgress(const TableInProgress&) = delete;
    TableInProgress& operator=(const TableInProgress&) = delete;

    const Table* ready() const noexcept { return ready_.load(std::memory_order_acquire); }  // null: not (yet) good
    bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }
    double done() const noexcept { return done_.load(std::memory_order_relaxed); }  // 0..1, rough
    // After finished(): what went wrong, or the table's note; empty if nothing.
    const std::string& note() const { return note_; }

  private:
    std::unique_ptr<Table> table_;
    std::string note_;
    std::atomic<const Table*> ready_{nullptr};
    std::atomic<bool> finished_{false};
    std::atomic<bool> cancel_{false};
    std::atomic<double> done_{0.0};
    std::thread worker_;
};

}  // namespace palpa::tactile
