#pragma once
// A part that is being changed: its JSON, its voxels, undo and redo in step with each other.

#include "parts/part_file.h"

namespace palpa::parts {

struct EditedPart {
    files::Json json;  // what save_part() writes: one entry of `shape` per edit
    Part part;
    std::vector<files::Json> undone;  // operations, the last one is redone first
};

// Throw InputError as read_part() does.
EditedPart open_part(const std::filesystem::path& path);
EditedPart edited_part(files::Json json, const std::string& file_name);

// Appends an operation, {"permute": {...}, "material": "soft"}, and returns how many voxels it changed. Throws InputError
// with everything as it was, redo included. edit() also refuses what leaves nothing, or two bodies.
std::int64_t append_operation(const files::Json& operation, EditedPart& edited);
std::int64_t edit(const files::Json& operation, EditedPart& edited);

// Take the last operation back, or do it again. Return false if there is none; the first one stays, since a part has at
// least one.
bool undo_edit(EditedPart& edited);
bool redo_edit(EditedPart& edited);

// Returns the JSON of a part's file as it stands in a copy elsewhere: the names of STL, run and curve files stay those of
// the same files from a folder of another name.
files::Json moved_part(files::Json json, const std::filesystem::path& file, const std::filesystem::path& copy);

// The part's file and those that it names: what a command reads that is given the part. Throws InputError if it is no JSON.
std::vector<std::filesystem::path> files_of_part(const std::filesystem::path& file);

// Writes the part as moved_part() says, whole or not at all, without the comments of the file it came from. Throws
// InputError as check_shape() does, and std::runtime_error if the file cannot be written.
void save_part(const EditedPart& edited, const std::filesystem::path& path);

}  // namespace palpa::parts
