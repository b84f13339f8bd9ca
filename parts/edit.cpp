#include "parts/edit.h"

#include "files/text.h"
#include "parts/shape_file.h"

namespace palpa::parts {
namespace {

std::string renamed(const std::string& file, const std::filesystem::path& from, const std::filesystem::path& to) {
    if (std::filesystem::path(file).is_absolute()) return file;
    return std::filesystem::proximate(from / file, to).string();
}

// Visits the names of the files of regions, however deep they lie.
template <class Visit>
void visit_names(const Visit& visit, files::Json& value) {
    if (value.is_object()) {
        if (value.contains("stl") && value["stl"].is_object() && value["stl"].contains("file"))
            visit(value["stl"]["file"]);
        for (const char* key : {"runs", "curve"}) {
            if (value.contains(key)) visit(value[key]);
        }
    }
    if (!value.is_structured()) return;
    for (files::Json& inner : value) visit_names(visit, inner);
}

template <class Visit>
void visit_names_of_part(const Visit& visit, files::Json& part) {
    for (const char* key : {"shape", "supports", "button"}) {
        if (part.is_object() && part.contains(key)) visit_names(visit, part[key]);
    }
}

}  // namespace

EditedPart edited_part(files::Json json, const std::string& file_name) {
    EditedPart out{std::move(json), {}, {}};
    out.part = parse_part(out.json, file_name);
    return out;
}

EditedPart open_part(const std::filesystem::path& path) { return edited_part(files::read_json(path), path.string()); }

std::int64_t append_operation(const files::Json& operation, EditedPart& edited) {
    files::JsonReader reader(operation, edited.part.file, "shape[" + std::to_string(edited.json["shape"].size()) + "]");
    const std::int64_t changed = apply_operation(reader, edited.part);
    edited.json["shape"].push_back(operation);
    edited.undone.clear();
    return changed;
}

std::int64_t edit(const files::Json& operation, EditedPart& edited) {
    auto undone = std::move(edited.undone);
    auto undone_voxels = std::move(edited.part.history.undone);
    const auto put_back = [&] {
        edited.undone = std::move(undone);
        edited.part.history.undone = std::move(undone_voxels);
    };
    const std::size_t before = edited.json["shape"].size();
    try {
        const std::int64_t changed = append_operation(operation, edited);
        // a change of material leaves all voxels where they are
        if (!operation.contains("permute")) check_shape(edited.part);
        return changed;
    } catch (...) {
        if (edited.json["shape"].size() > before) undo_edit(edited);
        put_back();
        throw;
    }
}

bool undo_edit(EditedPart& edited) {
    files::Json& shape = edited.json["shape"];
    if (shape.size() < 2 || !mechanics::undo(edited.part.voxels, edited.part.history)) return false;
    edited.undone.push_back(shape.back());
    shape.erase(shape.size() - 1);
    return true;
}

bool redo_edit(EditedPart& edited) {
    if (edited.undone.empty() || !mechanics::redo(edited.part.voxels, edited.part.history)) return false;
    edited.json["shape"].push_back(edited.undone.back());
    edited.undone.pop_back();
    return true;
}

files::Json moved_part(files::Json json, const std::filesystem::path& file, const std::filesystem::path& copy) {
    const std::filesystem::path from = std::filesystem::absolute(file).parent_path();
    const std::filesystem::path to = std::filesystem::absolute(copy).parent_path();
    if (from == to) return json;
    visit_names_of_part([&](files::Json& name) { name = renamed(name.get<std::string>(), from, to); }, json);
    return json;
}

std::vector<std::filesystem::path> files_of_part(const std::filesystem::path& file) {
    std::vector<std::filesystem::path> out{file};
    files::Json json = files::read_json(file);
    visit_names_of_part(
        [&](const files::Json& name) {
            if (name.is_string()) out.push_back(file.parent_path() / name.get<std::string>());
        },
        json);
    return out;
}

void save_part(const EditedPart& edited, const std::filesystem::path& path) {
    check_shape(edited.part);
    files::write_text_atomically(path, files::json_text(moved_part(edited.json, edited.part.file, path)));
}

}  // namespace palpa::parts
