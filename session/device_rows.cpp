#include "session/device_rows.h"

#include <stdexcept>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::session {
namespace {

constexpr std::string_view kNames[] = {"feedback", "hand_over"};

std::vector<std::string> columns_of(const std::vector<std::string>& feedback_fields) {
    if (feedback_fields.size() > kDeviceFields) throw std::invalid_argument("a device has at most 64 fields");
    std::vector<std::string> columns{"row", "time_s"};
    for (const std::string& name : field_names<PenContact>()) columns.push_back(name);
    columns.insert(columns.end(), feedback_fields.begin(), feedback_fields.end());
    return columns;
}

DeviceRowKind kind_of(const files::Table& table) {
    if (table.field(0) == kNames[0]) return DeviceRowKind::feedback;
    if (table.field(0) != kNames[1]) table.fail(0, "feedback or hand_over");
    return DeviceRowKind::hand_over;
}

}  // namespace

std::filesystem::path device_rows_of(const std::filesystem::path& trace, std::string_view device) {
    std::filesystem::path tsv = trace;
    return tsv.replace_extension("." + std::string(device) + ".tsv");
}

DeviceRowWriter::DeviceRowWriter(const std::filesystem::path& tsv, const std::vector<std::string>& feedback_fields)
    : file_(tsv), contact_fields_(field_names<PenContact>().size()), feedback_fields_(feedback_fields.size()) {
    for (const std::string& name : columns_of(feedback_fields)) text_.append(text_.empty() ? "" : "\t").append(name);
    file_.append(text_.append("\n"));
}

void DeviceRowWriter::write(const DeviceRow& row) {
    text_.assign(kNames[static_cast<std::size_t>(row.kind)]).push_back('\t');
    files::append_number(row.time_s, text_);
    const auto part = [&](DeviceRowKind kind, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i) {
            text_.push_back('\t');
            if (row.kind == kind)
                files::append_number(row.value[i], text_);
            else
                text_.append("n/a");
        }
    };
    part(DeviceRowKind::hand_over, contact_fields_);
    part(DeviceRowKind::feedback, feedback_fields_);
    file_.append(text_.append("\n"));
}

std::vector<DeviceRow> read_device_rows(const std::filesystem::path& tsv,
                                        const std::vector<std::string>& feedback_fields) {
    files::Table table = files::read_tsv(tsv);
    const std::vector<std::string> columns = columns_of(feedback_fields);
    for (const std::string& name : columns) table.column(name);
    if (table.columns() != columns) {
        throw files::bad_input(table.file(), "line 1", std::to_string(table.columns().size()) + " columns",
                               "the device's " + std::to_string(columns.size()) + ", each once and in their order");
    }
    const std::size_t contact_fields = field_names<PenContact>().size();
    std::vector<DeviceRow> rows;
    while (table.next()) {
        DeviceRow row{kind_of(table), table.finite_number(1), {}};
        if (!rows.empty() && row.time_s < rows.back().time_s) table.fail(1, "a time not before the row above");
        const bool contact = row.kind == DeviceRowKind::hand_over;
        const std::size_t first = contact ? 2 : 2 + contact_fields;
        const std::size_t n = contact ? contact_fields : feedback_fields.size();
        for (std::size_t i = 0; i < n; ++i) row.value[i] = table.finite_number(first + i);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace palpa::session
