// The measures that a criterion of a rubric may use, a row each; whoever includes this says before it what becomes of one:
//
//   MEASURE(NAME, WORDS, (WHAT), VALUE, REASON, MOMENTS, (PLACE))     FAMILY(KEY, MEMBERS, VALUE, REASON, MOMENTS)
//
// WHAT: further fields of scenarios::Measure (measures.h: which is better, where it ends, what it needs and counts).
// VALUE: with its bound, of the result `r` and what is asked `a`; no value where it cannot be measured (grading/result/measure_marking.cpp).
// REASON: why points were lost, in one line (grading/result/loss.h). MOMENTS: what `grade --why` lists (grading/feedback/loss_finder.h).
// PLACE: further fields of grading::MeasureMarking: zones, place in the JSON. Rows are in the order of the result's JSON.
// clang-format off
#define IN_ROW(...) __VA_OPT__(,) __VA_ARGS__

MEASURE("target_removed_percent", "of the target's volume",
        (.better = Better::more, .judges = Judges::work, .most = &most::percent, .counts = k_counts_target),
        known_to(r.volumes.target_removed_percent, r.volumes.target_removed_bound_percent), missed_target, missed_target, (IN("/volumes/")))
MEASURE("missed_mm3", "target left standing", (.judges = Judges::work, .most = &most::target, .counts = k_counts_target),
        of_volume(r.volumes.missed), missed_target, missed_target, (IN("/volumes/")))
MEASURE("removed_mm3", "all tissue removed", (.better = Better::by_task, .most = &most::tooth, .counts = k_counts_removed),
        of_volume(r.volumes.removed), removed_in_zones, removed_in_zones, (.zones = all_zones(true), IN("/volumes/")))
MEASURE("outside_mm3", "removed outside target, leeway and container, what is protected included",
        (.most = &most::tooth, .counts = k_counts_outside | k_counts_protected, .counts_protected = true),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::none, Zone::protected_}, IN("/volumes/")))
MEASURE("protected_mm3", "removed of what is protected, wherever it lies",
        (.most = &most::guarded, .needs = Needs::protection, .counts = k_counts_protected, .counts_protected = true),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::protected_}, IN("/volumes/")))
MEASURE("leeway_sides_mm3", "removed in the leeway beside the target",
        (.most = &most::leeway_sides, .needs = Needs::leeway_sides, .counts = k_counts_leeway),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::leeway_sides}, IN_OVERCUT))
MEASURE("leeway_bottom_mm3", "removed in the leeway below the target",
        (.most = &most::leeway_bottom, .needs = Needs::leeway_bottom, .counts = k_counts_leeway),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::leeway_bottom}, IN_OVERCUT))
MEASURE("container_sides_mm3", "damage beside the target",
        (.most = &most::container_sides, .needs = Needs::container_sides, .counts = k_counts_sides),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::container_sides}, IN_OVERCUT))
MEASURE("container_bottom_mm3", "damage below the target",
        (.most = &most::container_bottom, .needs = Needs::container_bottom, .counts = k_counts_bottom),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::container_bottom}, IN_OVERCUT))
MEASURE("container_mm3", "damage beside and below the target",
        (.most = &most::container, .needs = Needs::container, .counts = k_counts_sides | k_counts_bottom),
        in_zones(r, a), removed_in_zones, removed_in_zones, (.zones = {Zone::container_sides, Zone::container_bottom}))
MEASURE("overcut_mm3", "everything removed beyond target and leeway",
        (.most = &most::tooth, .counts = k_counts_sides | k_counts_bottom | k_counts_outside | k_counts_protected, .counts_protected = true),
        in_zones(r, a), removed_in_zones, removed_in_zones,
        (.zones = {Zone::container_sides, Zone::container_bottom, Zone::protected_, Zone::none}))
MEASURE("dice", "agreement of removed and target, 1 = equal",
        (.better = Better::more, .judges = Judges::work, .most = &most::one, .counts = k_counts_removed),
        known_to(r.volumes.dice, r.volumes.dice_bound), missed_and_beyond, dice, (.zones = all_zones(false), IN("/volumes/")))
FAMILY(k_wall_family, wall_measures(), worst_wall(r, a), at_walls, at_walls)
MEASURE("outline_length_mm", "mesial to distal, at the surface", (.better = Better::by_task, .judges = Judges::work),
        known_to(r.shape.length_mm, r.shape.bound_mm), figure_alone, length, (.json = "/shape/", .bound_json = "/shape/bound_mm"))
MEASURE("outline_width_mm", "buccal to lingual, at the surface", (.better = Better::by_task, .judges = Judges::work),
        known_to(r.shape.width_mm, r.shape.bound_mm), figure_alone, width, (.json = "/shape/", .bound_json = "/shape/bound_mm"))
MEASURE("outline_length_error_mm", "difference from the target's",
        (.judges = Judges::work, .most = &most::no_end, .counts = k_counts_target | k_counts_sides),
        known_to(r.shape.length_error_mm, 2 * r.shape.bound_mm), length_error, length, ())
MEASURE("outline_width_error_mm", "difference from the target's",
        (.judges = Judges::work, .most = &most::no_end, .counts = k_counts_target | k_counts_sides),
        known_to(r.shape.width_error_mm, 2 * r.shape.bound_mm), width_error, width, ())
MEASURE("depth_mm", "deepest point below the occlusal opening", (.better = Better::by_task, .judges = Judges::work),
        known_to(r.shape.depth_mm, r.shape.bound_mm), figure_alone, depth, (.json = "/shape/", .bound_json = "/shape/bound_mm"))
MEASURE("depth_error_mm", "difference from the target's",
        (.judges = Judges::work, .most = &most::no_end, .counts = k_counts_target | k_counts_bottom),
        known_to(r.shape.depth_error_mm, 2 * r.shape.bound_mm), depth_error, depth, ())
MEASURE("taper_deg", "opening of the side walls towards the occlusal side", (.better = Better::by_task),
        known_to(r.shape.taper_deg, r.shape.taper_bound_deg), figure_alone, taper, (.json = "/shape/", .bound_json = "/shape/taper_bound_deg"))
MEASURE("taper_error_deg", "difference from the target's", (.most = &most::no_end), taper_difference(r), taper_error, taper_error, ())
MEASURE("overhang_mm3", "roof of the target left above what the task opens (perforation.aims)",
        (.judges = Judges::work, .most = &most::target, .needs = Needs::aim, .counts = k_counts_target),
        r.access.overhang ? of_volume(*r.access.overhang) : MetricValue{}, overhang, overhang, (IN("/access/")))
MEASURE("canals_covered_percent", "of the canals' mouths, under hard tissue left on the straight line out",
        (.judges = Judges::work, .most = &most::percent, .needs = Needs::aim, .counts = k_counts_target),
        known_to(r.access.canals_covered_percent, r.access.canals_bound_percent), canals_covered, canals, (IN("/access/")))
MEASURE("floor_cut_mm3", "hard tissue removed below the target", (.most = &most::tooth, .counts = k_counts_bottom, .of_floor = true),
        of_volume(r.access.floor_cut), floor_cut, floor_cut, (IN("/access/")))
MEASURE("dentin_over_pulp_mm", "thinnest hard tissue left between the cavity and the pulp, 0 where it was opened",
        (.better = Better::more, .most = &most::no_end, .needs = Needs::pulp),
        known_to(r.over_pulp.dentin_mm, r.over_pulp.bound_mm), dentin_over_pulp, dentin_over_pulp, (IN("/pulp/")))
MEASURE("neighbour_nick_depth_mm", "deepest place cut into a neighbouring tooth, from its surface as it was",
        (.most = &most::no_end, .needs = Needs::neighbour, .counts = k_counts_neighbour),
        known_to(r.beside.nick_depth_mm, r.beside.nick_depth_bound_mm), nick, nick, (IN("/beside/")))
MEASURE("neighbour_nick_area_mm2", "surface of a neighbouring tooth that was cut away",
        (.most = &most::no_end, .needs = Needs::neighbour, .counts = k_counts_neighbour),
        known_to(r.beside.nick_area_mm2, r.beside.nick_area_bound_mm2), nick, nick, (IN("/beside/")))
MEASURE("neighbour_removed_mm3", "hard tissue removed of neighbouring teeth",
        (.most = &most::no_end, .needs = Needs::neighbour, .counts = k_counts_neighbour),
        of_volume(r.beside.neighbour_removed), nick, nick, (IN("/beside/")))
MEASURE("proximal_clearance_mm",
        "least distance from the neighbour over the part of the contact that the target opens; the contact's own while that stands",
        (.better = Better::more, .judges = Judges::work, .most = &most::no_end, .needs = Needs::neighbour),
        known_to(r.beside.clearance_mm, r.beside.clearance_bound_mm), clearance, clearance, (IN("/beside/")))
MEASURE("gum_removed_mm3", "gum cut away", (.most = &most::no_end, .needs = Needs::gum, .counts = k_counts_gum),
        of_volume(r.beside.gum_removed), gum, gum, (IN("/beside/")))
MEASURE("gum_touched_s", "tenths of a second in which gum was cut",
        (.most = &most::limit, .needs = Needs::gum, .counts = k_counts_gum, .of_exam = true),
        known_to(r.beside.gum_touched_s, r.beside.gum_touched_bound_s), gum, gum, (IN("/beside/")))
MEASURE("time_s", "until the exam ended", (.most = &most::limit, .counts = k_counts_time, .of_exam = true),
        known_to(r.motion.time_s, r.motion.time_bound_s), time_over, time, (IN("/")))
MEASURE("handpiece_time_s", "with the handpiece turning", (.most = &most::limit, .counts = k_counts_time, .of_exam = true),
        known_to(r.motion.handpiece_time_s, r.motion.handpiece_bound_s), figure_alone, handpiece_time, (IN("/")))
MEASURE("idle_s", "neither moving nor cutting", (.most = &most::limit, .counts = k_counts_time, .of_exam = true),
        known_to(r.motion.idle_s, r.motion.idle_bound_s), figure_alone, idle, (IN("/")))
MEASURE("force_mean_n", "while cutting", (.better = Better::by_task, .most = &most::no_end, .counts = k_counts_force, .of_exam = true),
        known_to(r.motion.force_mean_n, r.motion.force_bound_n), figure_alone, force, (.json = "/force/mean_n"))
MEASURE("force_peak_n", "largest on the hand", (.most = &most::no_end, .counts = k_counts_force, .of_exam = true),
        known_to(r.motion.force_peak_n, r.motion.force_bound_n), force_peak, force, (.json = "/force/peak_n"))
MEASURE("force_over_limit_s", "above force_limit_n",
        (.most = &most::over_limit, .needs = Needs::force_limit, .counts = k_counts_force, .of_exam = true),
        known_to(r.motion.force_over_limit_s, r.motion.over_limit_bound_s), force_over_limit, force_over_limit,
        (.json = "/force/over_limit_s", .bound_json = "/bounds/over_limit_s"))
MEASURE("path_mm", "way of the tip", (.most = &most::no_end, .of_exam = true),
        known_to(r.motion.path_mm, r.motion.path_bound_mm), figure_alone, steps, (IN("/")))
MEASURE("perforated", "1 when a tissue under perforation.faults was opened from the cavity",
        (.most = &most::fault, .needs = Needs::fault, .counts = k_counts_faults, .counts_faults = true, .reads = Reads::yes_no,
         .yes = said("opened"), .no = said("not opened")),
        exactly(r.perforation.fault.perforated ? 1.0 : 0.0), fault_opened, perforation, (.json = "/perforation/truth/", .whole = true))
MEASURE("perforation_volume_mm3", "removed from the cavity of the tissues under perforation.faults",
        (.needs = Needs::fault, .counts = k_counts_faults, .counts_faults = true),
        known_to(r.perforation.fault.volume_mm3, r.perforation.fault.bound_mm3), fault_opened, perforation,
        (.json = "/perforation/truth/volume_mm3", .bound_json = "/perforation/truth/bound_mm3"))
MEASURE("soft_tissue_outside_mm3", "removed of the tissues under perforation.faults from outside the tooth", (.needs = Needs::fault),
        known_to(r.perforation.fault.outside_mm3, r.perforation.fault.bound_mm3), swept_outside, perforation,
        (.json = "/perforation/truth/outside_mm3", .bound_json = "/perforation/truth/bound_mm3"))
MEASURE("perforation_events", "faulty breakthroughs seen in the force and confirmed by the tissue",
        (.most = &most::no_end, .counts = k_counts_faults, .counts_faults = true, .of_exam = true, .reads = Reads::count),
        fault_events(r), fault_felt, perforation, ())
FAMILY(k_tissue_family, tissue_measures(), of_tissue(r, a), tissue_touched, tissue)
MEASURE("steps_completed", "steps done",
        (.better = Better::more, .judges = Judges::work, .most = &most::steps, .of_exam = true, .reads = Reads::count),
        exactly(r.progress.steps_completed), figure_alone, steps, (.json = "/steps/completed", .whole = true))
MEASURE("steps_failed", "steps failed", (.most = &most::steps, .of_exam = true, .reads = Reads::count),
        exactly(r.progress.steps_failed), figure_alone, steps, (.json = "/steps/failed", .whole = true))
MEASURE("violations", "a bur that is not allowed, or a speed above max_rpm", (.most = &most::no_end, .of_exam = true, .reads = Reads::count),
        exactly(r.progress.violations), first_violation, steps, (.json = "/", .whole = true))

#undef IN_ROW
#undef MEASURE
#undef FAMILY
