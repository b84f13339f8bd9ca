#include <doctest/doctest.h>

#include "files/text.h"
#include "scene/plan.h"
#include "scene/tissue.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/scene/allocations.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

namespace {

Scene soft_scene(const std::string& block) {
    const TemporaryFolder folder;
    files::write_text_atomically(folder / "s.json", R"({"name": "n", "tissue": {"block": )" + block + "}}");
    return read_scene(folder / "s.json", kAssets);
}

std::string soft_refused(const std::string& block) {
    return message_of([&] { soft_scene(block); });
}

}  // namespace

TEST_CASE("soft block: what a device feels step by step is what a pen's force reaches") {
    const Scene scene = soft_scene(R"({"mu_Pa": 5000, "kappa_Pa": 30000, "cells": 4, "greatest_depth_mm": 5})");
    CHECK(takes_seconds(scene.tissue));
    const Plan plan = make_plan(scene);
    TissueWork finger = make_work(plan.tissue);
    Push push;
    for (int k = 1; k <= 80; ++k) push = push_to(plan.tissue, {}, 0.05e-3 * k, finger);
    const auto before = allocations();
    push = push_to(plan.tissue, {}, 4e-3, finger);
    CHECK(allocations() == before);
    CHECK_FALSE(push.inexact);
    TissueWork pen = make_work(plan.tissue);
    Contact contact;
    answer(plan.tissue, StageId::depth, {{}, push.force_N, {}, true, 1.0}, pen, contact);
    CHECK(contact.depth_m == close_to(4e-3).epsilon(2e-3));
    CHECK(push_to(plan.tissue, {}, 6e-3, finger).saturated);
}

TEST_CASE("soft block: bad input names the key, what was found and what was expected") {
    CHECK(contains(soft_refused("{}"), "mu_Pa"));
    CHECK(contains(soft_refused(R"({"mu_Pa": 1, "kappa_Pa": 0})"), "kappa_Pa"));
    CHECK(contains(soft_refused(R"({"mu_Pa": 1, "kappa_Pa": 1, "law": "linear"})"), "law"));
    CHECK(contains(soft_refused(R"({"mu_Pa": 1, "kappa_Pa": 1, "greatest_depth_mm": 8})"), "greatest_depth_mm"));
    CHECK(contains(soft_refused(R"({"mu_Pa": 1, "kappa_Pa": 1, "sphere_radius_mm": 30})"), "sphere_radius_mm"));
    CHECK(contains(soft_refused(R"({"mu_Pa": 1, "kappa_Pa": 1, "depth": 8})"), "depth"));
}
