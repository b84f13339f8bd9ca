#include <doctest/doctest.h>
#include <random>

#include "mechanics/bellows.h"
#include "tangible/actuators.h"
#include "tangible/device_model.h"
#include "tests/assets.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::tangible;
using namespace palpa::test;

namespace {

struct Shaken {
    DeviceModel model;
    Eigen::Matrix3Xd u_m;
};

// A device of the assets, its nodes moved by half a millimetre.
Shaken shaken(const char* file) {
    constexpr std::uint64_t kSeed = 11;
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> normal;
    Shaken out{make_device_model(read_soft_device(test::kAssets / "devices" / file)), {}};
    out.u_m.setZero(3, out.model.body.mesh.nodes_m.cols());
    for (Eigen::Index i = 0; i < 3 * out.model.free_nodes; ++i) out.u_m.data()[i] = 5e-4 * normal(random);
    return out;
}

Eigen::VectorXd gradient_of(const Shaken& s, const SoftActuator& actuator, const Eigen::Matrix3Xd& u_m) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(s.model.equations());
    add_gradient(actuator, {s.model.body.mesh.nodes_m, u_m}, s.model.free_nodes, 1.0, out);
    return out;
}

double times(const mechanics::BandMatrix& K, Eigen::Index row, Eigen::Index column) {
    const Eigen::Index below = std::max(row, column) - std::min(row, column);
    return below > K.band ? 0.0 : K.values(below, std::min(row, column));
}

}  // namespace

TEST_CASE("actuators: gradient and Hessian are the slopes of length and volume") {
    for (const char* file : {"strip.json", "accordion.json", "bellows.json"}) {
        CAPTURE(file);
        const Shaken s = shaken(file);
        std::mt19937_64 random(12);
        std::normal_distribution<double> normal;
        Eigen::Matrix3Xd step = Eigen::Matrix3Xd::Zero(3, s.u_m.cols());
        for (Eigen::Index i = 0; i < s.model.equations(); ++i) step.data()[i] = normal(random);
        constexpr double kStep_m = 1e-6;
        const Eigen::Matrix3Xd up = s.u_m + kStep_m * step;
        const Eigen::Matrix3Xd down = s.u_m - kStep_m * step;
        const Eigen::Map<const Eigen::VectorXd> along(step.data(), s.model.equations());
        const Eigen::Matrix3Xd& rest = s.model.body.mesh.nodes_m;
        for (const SoftActuator& actuator : s.model.actuators) {
            CAPTURE(actuator.name);
            const Eigen::VectorXd gradient = gradient_of(s, actuator, s.u_m);
            const double slope =
                (coordinate(actuator, {rest, up}) - coordinate(actuator, {rest, down})) / (2.0 * kStep_m);
            CHECK(std::abs(slope - gradient.dot(along)) < 1e-7 * gradient.norm() * along.norm());
            mechanics::BandMatrix K = mechanics::band_matrix(s.model.equations(), s.model.band);
            add_hessian(actuator, {rest, s.u_m}, 1.0, K);
            Eigen::VectorXd product = Eigen::VectorXd::Zero(along.size());
            for (Eigen::Index i = 0; i < along.size(); ++i) {
                for (Eigen::Index j = std::max<Eigen::Index>(0, i - K.band);
                     j <= std::min<Eigen::Index>(along.size() - 1, i + K.band); ++j)
                    product(i) += times(K, i, j) * along(j);
            }
            const Eigen::VectorXd change =
                (gradient_of(s, actuator, up) - gradient_of(s, actuator, down)) / (2.0 * kStep_m);
            CHECK((change - product).norm() < 1e-6 * change.norm());
        }
    }
}

TEST_CASE("actuators: the volume of a straight bellows is that of its inside") {
    files::Json json = files::read_json(test::kAssets / "devices" / "bellows.json");
    json.merge_patch(files::Json::parse(R"({"mesh": {"bellows": {"amplitude_mm": 0, "sectors": 64}}})"));
    const DeviceModel model = make_device_model(parse_soft_device(json, "straight.json", test::kAssets / "devices"));
    const double expected_m3 = 32.0 * std::sin(2.0 * 3.14159265358979 / 64.0) * 0.022 * 0.022 * 0.06;
    CHECK(-model.rest[3] == close_to(expected_m3).epsilon(1e-9));
}
