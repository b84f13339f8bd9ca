// palpa part edit

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/part_design.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "parts/edit.h"
#include "parts/info.h"

namespace palpa::app {
namespace {

struct EditOptions {
    std::string file, output;
    std::vector<std::string> operations;
    int undo = 0;
    bool json = false;
};

void edit_part(const EditOptions& options) {
    files::check_output(options.output, parts::files_of_part(options.file));
    parts::EditedPart edited = parts::open_part(options.file);
    const std::size_t there = edited.json["shape"].size();
    for (int i = 0; i < options.undo; ++i) {
        if (!parts::undo_edit(edited)) {
            throw files::bad_input(options.file, "--undo", std::to_string(options.undo),
                                   "fewer than the " + std::to_string(there) + " operations of shape");
        }
    }
    files::Json report{{"part", options.output}, {"undone", options.undo}};
    report["changed_voxels"] = files::Json::array();
    for (const std::string& operation : options.operations)
        report["changed_voxels"].push_back(parts::append_operation(files::parse_json(operation, "--op"), edited));
    say_warnings(edited.part);  // also of what an operation has just added
    parts::save_part(edited, options.output);
    report["operations"] = edited.json["shape"].size();
    report["runs_sha256"] = parts::runs_sha256(edited.part.voxels);
    if (options.json) {
        std::printf("%s", files::json_text(report).c_str());
        return;
    }
    const auto operations = static_cast<std::int64_t>(edited.json["shape"].size());
    std::printf("%s: %s\n", files::printable(options.output).c_str(), files::counted(operations, "operation").c_str());
    for (const files::Json& changed : report["changed_voxels"])
        std::printf("  %s changed\n", files::counted(changed.get<std::int64_t>(), "voxel").c_str());
}

}  // namespace

void add_part_edit(CLI::App& part) {
    auto options = std::make_shared<EditOptions>();
    CLI::App* edit = part.add_subcommand("edit", "Append operations to a part's shape, or drop its last ones");
    edit->add_option("PART", options->file, "part JSON")->required();
    edit->add_option(
            "--op", options->operations,
            R"(operation as JSON, as often as needed: '{"sculpt": {"points_mm": [[1, 2, 3]], "radius_mm": 1}}')")
        ->allow_extra_args(false);
    edit->add_option("--undo", options->undo, "drop so many operations first")->check(CLI::Range(0, 1'000'000));
    edit->add_option("-o,--output", options->output, "part JSON to write; replaces a file of that name")->required();
    edit->add_flag("--json", options->json, "print one JSON object on standard output");
    edit->callback([options] { edit_part(*options); });
}

}  // namespace palpa::app
