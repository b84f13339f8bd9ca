// 3MF by lib3mf 1.8.

#include <Model/COM/NMR_DLLInterfaces.h>
#include <cstring>
#include <stdexcept>

#include "files/sha256.h"
#include "files/text.h"
#include "parts/export/export.h"
#include "parts/info.h"

namespace palpa::parts {
namespace {

// An object of lib3mf's.
class Handle {
  public:
    Handle() = default;
    ~Handle() {
        if (object_ != nullptr) NMR::lib3mf_release(object_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    NMR::PLib3MFBase* get() const { return object_; }
    NMR::PLib3MFBase** out() { return &object_; }  // for functions that make one

  private:
    NMR::PLib3MFBase* object_ = nullptr;
};

void check(LIB3MFRESULT result, const char* doing) {
    if (result != LIB3MF_OK) {
        throw std::runtime_error(std::string("3MF: ") + doing + " failed, lib3mf's code " + std::to_string(result));
    }
}

// 8-4-4-4-12 hexadecimal digits, made from what the identifier stands for; version 8 (RFC 9562, section 5.8).
std::string uuid_of(const std::string& what) {
    std::string hex = files::sha256_hex(what).substr(0, 32);
    hex[12] = '8';
    hex[16] = "89ab"[static_cast<unsigned char>(hex[16]) % 4];
    for (const std::size_t dash : {8U, 13U, 18U, 23U}) hex.insert(dash, 1, '-');
    return hex;
}

// Where lib3mf's archive goes. Its callbacks return 0 for success.
struct Sink {
    std::string bytes;
    std::size_t at = 0;
};
BOOL write_to(const BYTE* data, const DWORD n, const void* sink) {
    auto& to = *static_cast<Sink*>(const_cast<void*>(sink));
    if (to.at + n > to.bytes.size()) to.bytes.resize(to.at + n);
    std::memcpy(to.bytes.data() + to.at, data, n);
    to.at += n;
    return 0;
}
BOOL seek_in(const std::uint64_t at, const void* sink) {
    static_cast<Sink*>(const_cast<void*>(sink))->at = static_cast<std::size_t>(at);
    return 0;
}

BYTE hex_byte(const std::string& colour, std::size_t at) {
    return static_cast<BYTE>(std::stoi(colour.substr(at, 2), nullptr, 16));
}

void add_mesh(const Surface& surface, NMR::PLib3MFBase* mesh) {
    std::vector<NMR::MODELMESHVERTEX> vertices(surface.vertices_m.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        for (std::size_t c = 0; c < 3; ++c)
            vertices[v].m_fPosition[c] = static_cast<float>(1e3 * surface.vertices_m[v][c]);
    }
    std::vector<NMR::MODELMESHTRIANGLE> triangles(surface.triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) triangles[t].m_nIndices[c] = static_cast<DWORD>(surface.triangles[t][c]);
    }
    check(NMR::lib3mf_meshobject_setgeometry(mesh, vertices.data(), static_cast<DWORD>(vertices.size()),
                                             triangles.data(), static_cast<DWORD>(triangles.size())),
          "taking the triangles");
}

// Adds a material's mesh object, and makes it a component.
void add_material(const PartMaterial& material, const Surface& surface, const std::string& seed, std::uint32_t group_id,
                  NMR::PLib3MFBase* model, NMR::PLib3MFBase* group, std::vector<Handle>& meshes) {
    DWORD index = 0;
    const std::string& colour = material.colour;
    check(NMR::lib3mf_basematerial_addmaterialutf8(group, material.name.c_str(), hex_byte(colour, 1),
                                                   hex_byte(colour, 3), hex_byte(colour, 5), &index),
          "adding a material");
    // the call above writes alpha 0, which is nothing to be seen
    check(NMR::lib3mf_basematerial_setdisplaycolorrgba(group, index, hex_byte(colour, 1), hex_byte(colour, 3),
                                                       hex_byte(colour, 5), 255),
          "colouring a material");
    Handle& mesh = meshes[static_cast<std::size_t>(index)];
    check(NMR::lib3mf_model_addmeshobject(model, mesh.out()), "adding a mesh");
    check(NMR::lib3mf_object_setnameutf8(mesh.get(), material.name.c_str()), "naming a mesh");
    check(NMR::lib3mf_object_setuuidutf8(mesh.get(), uuid_of(seed + " mesh " + std::to_string(index)).c_str()),
          "identifying a mesh");
    add_mesh(surface, mesh.get());
    Handle property;
    check(NMR::lib3mf_object_createdefaultpropertyhandler(mesh.get(), property.out()), "giving a mesh its material");
    check(NMR::lib3mf_defaultpropertyhandler_setbasematerial(property.get(), group_id, index),
          "giving a mesh its material");
}

std::string written(NMR::PLib3MFBase* model) {
    Handle writer;
    check(NMR::lib3mf_model_querywriter(model, "3mf", writer.out()), "making a writer");
    Sink sink;
    check(NMR::lib3mf_writer_writetocallback(writer.get(), reinterpret_cast<void*>(&write_to),
                                             reinterpret_cast<void*>(&seek_in), &sink),
          "writing");
    return std::move(sink.bytes);
}

}  // namespace

std::string three_mf_bytes(const Part& part, const std::vector<Surface>& surfaces) {
    const std::string seed = "palpa part " + part.name + " " + runs_sha256(part.voxels);
    Handle model, group, whole, item;
    check(NMR::lib3mf_createmodel(model.out()), "making a model");
    check(NMR::lib3mf_model_setunit(model.get(), NMR::MODELUNIT_MILLIMETER), "setting the unit");
    check(NMR::lib3mf_model_addbasematerialgroup(model.get(), group.out()), "adding materials");
    DWORD group_id = 0;
    check(NMR::lib3mf_basematerial_getresourceid(group.get(), &group_id), "adding materials");
    std::vector<Handle> meshes(surfaces.size());
    for (const Surface& surface : surfaces) {
        add_material(part.materials[static_cast<std::size_t>(surface.material)], surface, seed, group_id, model.get(),
                     group.get(), meshes);
    }
    check(NMR::lib3mf_model_addcomponentsobject(model.get(), whole.out()), "adding the part");
    check(NMR::lib3mf_object_setnameutf8(whole.get(), part.name.c_str()), "naming the part");
    check(NMR::lib3mf_object_setuuidutf8(whole.get(), uuid_of(seed + " part").c_str()), "identifying the part");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        Handle component;
        check(NMR::lib3mf_componentsobject_addcomponent(whole.get(), meshes[i].get(), nullptr, component.out()),
              "adding a component");
        check(NMR::lib3mf_component_setuuidutf8(component.get(),
                                                uuid_of(seed + " component " + std::to_string(i)).c_str()),
              "identifying a component");
    }
    check(NMR::lib3mf_model_addbuilditem(model.get(), whole.get(), nullptr, item.out()), "adding the build item");
    check(NMR::lib3mf_builditem_setuuidutf8(item.get(), uuid_of(seed + " item").c_str()), "identifying the item");
    check(NMR::lib3mf_model_setbuilduuidutf8(model.get(), uuid_of(seed + " build").c_str()), "identifying the build");
    return written(model.get());
}

std::vector<ExportedFile> export_three_mf(const Part& part, const std::vector<Surface>& surfaces,
                                          const std::filesystem::path& file) {
    files::write_text_atomically(file, three_mf_bytes(part, surfaces));
    std::vector<ExportedFile> out;
    for (const Surface& surface : surfaces) {
        out.push_back({file.string(), part.materials[static_cast<std::size_t>(surface.material)].name,
                       static_cast<std::int64_t>(surface.triangles.size()), 0, volume_m3(surface)});
    }
    return out;
}

}  // namespace palpa::parts
