#pragma once
// All words that the screens show, in one place: change this file for another language or other words. Each {} is
// replaced by a value. Words of the page around the program are at the end. Messages about files and command lines are
// in the code that reports them, and names that also occur in files (tools, findings, sources) are with their types.

#include "files/filled.h"

namespace palpa::app::words {

using files::filled;

// buttons of several screens
inline constexpr const char* kBack = "Back";
inline constexpr const char* kClose = "Close";
inline constexpr const char* kMenu = "Menu";
inline constexpr const char* kCtrlQ = "Ctrl Q";
inline constexpr const char* kEscape = "Esc";
inline constexpr const char* kEnter = "Enter";
inline constexpr const char* kContinue = "Continue";
inline constexpr const char* kStart = "Start";
inline constexpr const char* kSave = "Save";
inline constexpr const char* kDone = "Done";

// menu
inline constexpr const char* kTrial = "Trial";
inline constexpr const char* kPractice = "Practice";
inline constexpr const char* kTest = "Test";
inline constexpr const char* kRestartTrial = "Restart trial";
inline constexpr const char* kDominantHand = "Dominant hand";
inline constexpr const char* kLeft = "Left";
inline constexpr const char* kRight = "Right";
inline constexpr const char* kSideView = "Side view";
inline constexpr const char* kShown = "Shown";
inline constexpr const char* kHidden = "Hidden";
inline constexpr const char* kContactOfFinger = "Contact point of a finger";
inline constexpr const char* kUnderFinger = "Under it";
inline constexpr const char* kAboveFinger = "Above it";
inline constexpr const char* kScreenScale = "Screen scale";
inline constexpr const char* kDeviceCheck = "Device check";
inline constexpr const char* kCalibratePressure = "Calibrate pressure";
inline constexpr const char* kMaps = "Maps";
inline constexpr const char* kPerformance = "Performance";
inline constexpr const char* kFullScreen = "Full screen";
inline constexpr const char* kTrials = "Trials";
inline constexpr const char* kMode = "Mode";
inline constexpr const char* kQuit = "Quit";
inline constexpr const char* kScene = "Scene";
inline constexpr const char* kCalibrationProfile = "Calibration profile";
inline constexpr const char* kOnThisTablet = "On this tablet";
inline constexpr const char* kStudies = "Studies";
inline constexpr const char* kPageSettings = "Settings";
inline constexpr const char* kPageExperimenter = "Experimenter";
inline constexpr const char* kGuidedStart = "Guided start";
inline constexpr const char* kHistory = "History";
inline constexpr const char* kTextSize = "Text size";
inline constexpr const char* kKeepResults = "Results of your trials";
inline constexpr const char* kKept = "Keep";
inline constexpr const char* kNotKept = "Do not keep";
inline constexpr const char* kDisplayAndInput = "Display and input";

// performance of every stage
inline constexpr const char* kStage = "stage";
inline constexpr const char* kError = "error";
inline constexpr const char* kMicroseconds = "us (median)";
inline constexpr const char* kMicroseconds99 = "us (p99)";
inline constexpr const char* kCalls = "calls";
inline constexpr const char* kFrameTimes =
    "Input to frame {} ms (p99 {}), without drawing {} ms. Frame {} ms without drawing (p99 {}), drawing {} ms. "
    "{} frames/s, {} samples, {} steps dropped, {} along fast strokes skipped, {} contacts not settled.";

// trial
inline constexpr const char* kForce = "Force";
inline constexpr const char* kDepth = "Depth";
inline constexpr const char* kLag = "Lag";
inline constexpr const char* kDelay = "Delay";
inline constexpr const char* kPhantom = "Phantom";
inline constexpr const char* kBeyondKnownDepth = "beyond the known depth";
inline constexpr const char* kCardTooLarge = "At this scale a bank card is larger than this window.";
inline constexpr const char* kNotMeasuredHere = "not measured here";
inline constexpr const char* kBeyondLinear = "beyond the linear range";
inline constexpr const char* kNotSettled = "the contact did not settle";
inline constexpr const char* kLeavingLinear = "leaving the linear range";
inline constexpr const char* kFirstSurface = "First surface";
inline constexpr const char* kSecondSurface = "Second surface";
inline constexpr const char* kUnsure = "unsure";
inline constexpr const char* kSure = "sure";
inline constexpr const char* kUndo = "Undo";
inline constexpr const char* kFinish = "Finish";
inline constexpr const char* kDismiss = "Dismiss";
inline constexpr const char* kTrialStopped =
    "No trial is running: the last one could not begin, or be written to its end. Restart trial (R) begins another.";
inline constexpr const char* kPressByHolding = "Press by holding";
inline constexpr const char* kAnalyticTissue = "Tissue: closed-form model, not a recording";
inline constexpr const char* kSimulatedTissue = "Tissue: simulated, not a recording";
inline constexpr const char* kTooSmall = "The window is too small for the controls; keys still work";
inline constexpr const char* kLight = "light";
inline constexpr const char* kMedium = "medium";
inline constexpr const char* kDeep = "deep";
inline constexpr const char* kPairOf = "Pair {}";
inline constexpr const char* kTrialOf = "Trial {}";
inline constexpr const char* kWithoutLevel = "This device does not report {}, which calibration profile {} needs.";
inline constexpr const char* kShownAt = "Tissue shown at {} % of its true size";
inline constexpr const char* kBeyond = "beyond";
inline constexpr const char* kMoreThan = "> {} mm";
inline constexpr const char* kMarkFirst = "Mark";
inline constexpr const char* kMarks = "Mark ({})";
inline constexpr const char* kPause = "Pause";
inline constexpr const char* kPaused = "Paused";
inline constexpr const char* kPausedMeans = "The clock is stopped. Nothing is lost.";
inline constexpr const char* kSceneAndMode = "{}: {}";

// results of a trial
inline constexpr const char* kSensitivity = "Sensitivity";
inline constexpr const char* kPpv = "PPV";
inline constexpr const char* kFalsePositives = "False positives";
inline constexpr const char* kTime = "Time";
inline constexpr const char* kCoverageAtLeast = "Coverage (at least)";
inline constexpr const char* kShareOf = "{} ({}/{})";
inline constexpr const char* kRestart = "Restart";
inline constexpr const char* kNext = "Next";
inline constexpr const char* kSavePicture = "Save picture";
inline constexpr const char* kNotTouched = "not touched";
inline constexpr const char* kMarkDuplicate = "{} duplicate";
inline constexpr const char* kMarkFalse = "{} false positive";
inline constexpr const char* kFoundOf = "Found {} of {}";
inline constexpr const char* kDownTo = ", down to {} mm";

// tooltips
inline constexpr const char* kHintMenu = "Other tissues, settings, tools of the experimenter";
inline constexpr const char* kHintPause = "Stop the clock";
inline constexpr const char* kHintContinue = "Start the clock again";
inline constexpr const char* kHintHelp = "All keys";
inline constexpr const char* kHintMark = "Marks the place that you pressed last (the dashed ring)";
inline constexpr const char* kHintConfidence = "How sure are you of the last mark? 1 is unsure, 5 is sure.";
inline constexpr const char* kHintUndo = "Removes the last mark";
inline constexpr const char* kHintFinishStudy = "Ends the trial";
inline constexpr const char* kHintFinish = "Ends the trial and shows what was there";
inline constexpr const char* kHintSensitivity = "Share of the nodules that you found";
inline constexpr const char* kHintPpv = "Positive predictive value: share of your marks that are on a nodule";
inline constexpr const char* kHintCoverage = "Share of the tissue that you pressed at least so deep";
inline constexpr const char* kHintRestart = "Repeats the trial on the same tissue";
inline constexpr const char* kHintNext = "Another trial, with the tissue turned another way";
inline constexpr const char* kHintPractice = "The nodules are shown all the time";
inline constexpr const char* kHintTest = "The nodules are hidden until you finish, and the tissue is turned";
inline constexpr const char* kHintPerformance = "Time and error of every stage, and the limits of the tissue model";
inline constexpr const char* kHintScale = "Measure the screen, so that the tissue is drawn true to size";
inline constexpr const char* kHintDevices = "What pens and fingers report, and whether that is enough";

// advice after a trial
inline constexpr const char* kAdviceNotTouched = "You missed {}: the {} was never examined.";
inline constexpr const char* kAdvicePassed = "You missed {}: you never pressed on it, in the {}.";
inline constexpr const char* kAdviceTooLight =
    "You missed {}: you pressed there, but too lightly. Press until the bar reaches medium.";
inline constexpr const char* kAdviceNotMarked =
    "You missed {}: you pressed on it but did not mark it. Compare it with the tissue beside it.";
inline constexpr const char* kAdviceFalse =
    "{} of {} marks are on no nodule. Cross a place from two sides before you mark it.";
inline constexpr const char* kAdviceUnexamined =
    "You found every nodule, but the {} was never examined: a nodule there would have been missed.";
inline constexpr const char* kAdviceMostMissed =
    "You missed {}: {} % of the tissue was never examined. Go over all of it, in lanes.";
inline constexpr const char* kAdviceMostUnexamined =
    "You found every nodule, but {} % of the tissue was never examined: a nodule there would have been missed.";
inline constexpr const char* kAdviceGood = "You found every nodule, and every mark is on a nodule.";
inline constexpr const char* kAdviceNotScored =
    "This map does not say which nodules it has, so marks are not scored. `palpa maps detect MAP --write` looks for "
    "them.";
inline constexpr const char* kMarksMade = "Marks";
inline constexpr const char* kAdviceNoNodules = "This tissue has no nodules, and you marked none.";
inline constexpr const char* kUpperLeft = "upper left";
inline constexpr const char* kUpperMiddle = "upper middle";
inline constexpr const char* kUpperRight = "upper right";
inline constexpr const char* kMiddleLeft = "left side";
inline constexpr const char* kMiddle = "middle";
inline constexpr const char* kMiddleRight = "right side";
inline constexpr const char* kLowerLeft = "lower left";
inline constexpr const char* kLowerMiddle = "lower middle";
inline constexpr const char* kLowerRight = "lower right";
inline constexpr const char* kConfidenceOf = ", confidence {}";

// guided start
inline constexpr const char* kStepOf = "Step {} of {}";
inline constexpr const char* kSkip = "Skip";
inline constexpr const char* kGuidedPress = "Press inside the ring. The surface gives way: this tissue is soft.";
inline constexpr const char* kGuidedSlide =
    "Now press and slide slowly across the other ring, from side to side. The indenter lags behind your hand: this "
    "place is stiff, a nodule.";
inline constexpr const char* kGuidedMark =
    "You have felt a nodule. Mark it with Mark; the mark goes where you pressed last.";
inline constexpr const char* kGuidedSure = "How sure are you? Choose 1 (unsure) to 5 (sure).";
inline constexpr const char* kGuidedFinish =
    "In a trial you would now examine the rest of the tissue. Choose Finish to see the result.";
inline constexpr const char* kGuidedResult =
    "The result: solid rings are nodules that you found, dashed rings are nodules that you missed. The colours show "
    "how deep you pressed, and hatching shows what you never touched.";
inline constexpr const char* kGuidedEnds =
    "Practice shows the nodules all the time. A test hides them until you finish.";
inline constexpr const char* kStartPractice = "Start a practice trial";
inline constexpr const char* kRepeatGuided = "Repeat";

// help
inline constexpr const char* kKeys = "Keys";
inline constexpr const char* kKeyArrows = "Arrows";
inline constexpr const char* kKeyArrowsDo = "move the indenter; with Shift slowly";
inline constexpr const char* kKeySpace = "Space, held";
inline constexpr const char* kKeySpaceDo = "press, harder the longer it is held";
inline constexpr const char* kKeyPages = "Page Up, Page Down";
inline constexpr const char* kKeyPagesDo = "press harder, softer";
inline constexpr const char* kKeyMark = "M";
inline constexpr const char* kKeyMarkDo = "mark the place that was pressed last";
inline constexpr const char* kKeyConfidence = "1 to 5";
inline constexpr const char* kKeyConfidenceDo = "confidence of the last mark";
inline constexpr const char* kKeyUndo = "U";
inline constexpr const char* kKeyUndoDo = "remove the last mark; parts: undo (Ctrl+Y redo, J next method)";
inline constexpr const char* kKeyFinish = "F";
inline constexpr const char* kKeyFinishDo = "finish the trial";
inline constexpr const char* kKeyPause = "P";
inline constexpr const char* kKeyPauseDo = "pause, continue";
inline constexpr const char* kKeyAgain = "R";
inline constexpr const char* kKeyAgainDo = "restart the trial on the same tissue";
inline constexpr const char* kKeyNext = "N";
inline constexpr const char* kKeyNextDo = "after a trial: the tissue turned another way";
inline constexpr const char* kKeyPicture = "S";
inline constexpr const char* kKeyPictureDo = "after a trial: save a picture";
inline constexpr const char* kKeyMenu = "F10 or Tab";
inline constexpr const char* kKeyMenuDo = "menu; arrows and Enter choose in it";
inline constexpr const char* kKeyScreens = "V, B, D, Z, T, G, E";
inline constexpr const char* kKeyScreensDo =
    "history, maps, device check, screen scale, arm and pins, soft device, parts";
inline constexpr const char* kKeyScreensWeb = "B, D, Z, T, Y, E";
inline constexpr const char* kKeyScreensWebDo =
    "maps, device check, screen scale, trials on this tablet, studies, parts";
inline constexpr const char* kKeyInset = "X";
inline constexpr const char* kKeyInsetDo = "show or hide the side view";
inline constexpr const char* kKeyHold = "H";
inline constexpr const char* kKeyHoldDo = "press by holding, with a pen that has no pressure";
inline constexpr const char* kKeyCost = "C";
inline constexpr const char* kKeyHistory = "V";
inline constexpr const char* kKeyMaps = "B";
inline constexpr const char* kKeyDevices = "D";
inline constexpr const char* kKeyScale = "Z";
inline constexpr const char* kKeyCostDo = "performance, for the experimenter";
inline constexpr const char* kKeyStop = "F12";
inline constexpr const char* kKeyStopDo = "stop arm, pins and soft device at once, on every screen";
inline constexpr const char* kKeyWindow = "F11, Ctrl Q, Esc";
inline constexpr const char* kKeyWindowDo = "full screen, quit, back";
inline constexpr const char* kKeyWindowWeb = "F11, Esc";
inline constexpr const char* kKeyWindowWebDo = "full screen, back";

// history
inline constexpr const char* kNoHistory = "No results yet. Each finished trial that is kept is listed here.";
inline constexpr const char* kHistoryKeptIn = "Kept in {}.";
inline constexpr const char* kHistoryNotKept = "Results are not kept: see the settings.";
// of a replay, or without a home folder
inline constexpr const char* kHistoryNotThisRun = "The results of this run are not kept.";
inline constexpr const char* kDeleteResults = "Delete all results";
inline constexpr const char* kDeleteAsk = "Delete the results of all trials ({})? They cannot be restored.";
inline constexpr const char* kDeleteAskUnread =
    "Delete the results of all trials ({}), and those that cannot be read ({})? They cannot be restored.";
inline constexpr const char* kDeleteNow = "Delete";
inline constexpr const char* kCancel = "Cancel";
inline constexpr const char* kLearningCurve = "Learning curve (filled: test, hollow: practice)";
inline constexpr const char* kFoundAxis = "nodules found (%)";
inline constexpr const char* kTrialAxis = "trial";
inline constexpr const char* kPlay = "Play";
inline constexpr const char* kHistoryLine = "{}  {}  {}";
inline constexpr const char* kHistoryNotScored = "Nodules not known, marks: {}";
inline constexpr const char* kHistoryNone = "No nodules, false positives: {}";
inline constexpr const char* kHistoryFound = "Found {} of {}, false positives: {}";

// parts
inline constexpr const char* kParts = "Parts";
inline constexpr const char* kKeyParts = "E";
inline constexpr const char* kHintParts = "Parts of several materials: press them, change them, compare two designs";
inline constexpr const char* kToolPress = "Press";
inline constexpr const char* kToolSculpt = "Cut";
inline constexpr const char* kToolPermute = "Swap";
inline constexpr const char* kHintToolPress = "The pen presses (or pulls) the part";
inline constexpr const char* kHintToolSculpt = "The pen cuts a channel through the part";
inline constexpr const char* kHintToolPermute = "The pen gives the material under it another one";
inline constexpr const char* kToolRadius = "{} mm";
inline constexpr const char* kHintMaterial = "The material that Swap gives";
inline constexpr const char* kHintUndoEdit = "Takes the last change back";
inline constexpr const char* kRedo = "Redo";
inline constexpr const char* kKeyRedo = "Ctrl+Y";
inline constexpr const char* kHintRedoEdit = "Makes the change again that was taken back last";
inline constexpr const char* kProfileGone =
    "{}: the profile that was chosen is gone. Until another one is chosen, each scene has its own.";
inline constexpr const char* kProfileOfScene =
    "Named on the command line, this scene keeps its own calibration profile, {}. Yours, {}, can be chosen in the "
    "menu.";
inline constexpr const char* kNoSuchMaterial = "This design has no material {}.";
inline constexpr const char* kNothingChanged =
    "Nothing was changed: no part is there, it would fall in two, or it is so already.";
inline constexpr const char* kEarlierEdits = "Earlier changes";
inline constexpr const char* kHintEarlierEdits = "Opens the designs as they were changed last";
inline constexpr const char* kDesignKept = "Your changes are kept in {}, in the folder {}.";
inline constexpr const char* kDesignKeptHere = "Your changes are kept in this browser.";
inline constexpr const char* kDesignNotKept = "Your changes are not stored. Save them before you leave this page.";
inline constexpr const char* kSaveDesign = "Save {} to a file";
inline constexpr const char* kHintSaveDesign =
    "Saves the changed design to a file, to evaluate or export it on the desk";
inline constexpr const char* kMagnify = "5 times";
inline constexpr const char* kHintMagnify = "Draws displacements five times as large as they are";
inline constexpr const char* kNextMethod = "Next method";
inline constexpr const char* kKeyMethod = "J";
inline constexpr const char* kKeyRadius = "K";
inline constexpr const char* kKeyMaterial = "L";
inline constexpr const char* kKeyMagnify = "5";
inline constexpr const char* kKeyEarlier = "O";
inline constexpr const char* kHintMethod = "How displacements are computed; changes between presses only";
inline constexpr const char* kForceOverTime = "Force over time";
inline constexpr const char* kForceOverTravel = "Force over travel";
inline constexpr const char* kSeconds = "s";
inline constexpr const char* kMillimetres = "mm";
inline constexpr const char* kNewtons = "N";
inline constexpr const char* kButtonOn = "on";
inline constexpr const char* kButtonOff = "off";
inline constexpr const char* kPressesAir = "The press meets no part";
inline constexpr const char* kMethodAppliesTo = "{}: {} applies up to {} mm here. Just beyond, {}.";
inline constexpr const char* kMethodNeverApplies = "{}: {} does not apply: {}.";
inline constexpr const char* kCellsPending = "Finite cells: {} % computed; beams answer meanwhile.";
inline constexpr const char* kSimulatedParts = "Simulated: linear elastic, small displacements.";
inline constexpr const char* kSimulatedButtons =
    "Simulated: a push button answers by its cover and its support. Cuts and swaps change its picture only.";

// force arm and shape display
inline constexpr const char* kTactile = "Arm and pins";
inline constexpr const char* kKeyTactile = "T";
inline constexpr const char* kHintTactile = "Force arm and shape display: what is wanted, what was reached, faults";
inline constexpr const char* kPins = "Pins";
inline constexpr const char* kPinsDrawn = "Pins (drawn)";
inline constexpr const char* kPinsWanted = "Pins wanted (0.1 mm)";
inline constexpr const char* kPinsReachedEstimate = "Reached (estimate)";
inline constexpr const char* kPinsReachedTrue = "Reached (simulator)";
inline constexpr const char* kMiddleRow = "Middle row";
inline constexpr const char* kMiddleRowBoth = "Middle row: bars wanted, lines reached";
inline constexpr const char* kPinsOnlyDrawn = "The scene names no device: pins are only drawn.";
inline constexpr const char* kNoTactile = "This scene has no force arm and no shape display.";
inline constexpr const char* kDevicesOpening = "The devices are getting ready.";
inline constexpr const char* kTactileRuns = "Running";
inline constexpr const char* kTactileRests = "The devices rest: no trial is running.";
inline constexpr const char* kHolds = "At the limit of force, or of the tissue: force and shape hold.";
inline constexpr const char* kStoppedBy = "Stopped: {}. No force, and the pins rest, until you choose Release.";
inline constexpr const char* kRestsSince = "No force, and the pins rest: {}.";
inline constexpr const char* kStoppedBanner =
    "Stopped: {}. No force, and the pins rest. Press T, or choose Arm and pins in the menu, to release them.";
inline constexpr const char* kStoppedInStudy = "Stopped: {}. No force, and the pins rest.";
inline constexpr const char* kStopDevices = "Stop";
inline constexpr const char* kReleaseDevices = "Release";
inline constexpr const char* kOfLimit = "{} (limit {})";
inline constexpr const char* kForceSensor = "Force sensor";
inline constexpr const char* kHoldLine = "Hold";
inline constexpr const char* kHeldNow = "force and shape hold";
inline constexpr const char* kLinearRange = "Linear range";
inline constexpr const char* kWithinLinear = "within";
inline constexpr const char* kOverEdge = "The finger reaches beyond the edge of the tissue.";
inline constexpr const char* kMismatch = "Mismatch";
inline constexpr const char* kPinsBehind = "Pins behind";
inline constexpr const char* kClippedPins = "Pins clipped";
inline constexpr const char* kShapeScale = "Shape scaled";
inline constexpr const char* kLink = "Link";
inline constexpr const char* kLinkTimes = "{} ms (p99 {}), {} lost";
inline constexpr const char* kLinkSilent = "no answer for {}";
inline constexpr const char* kSwing = "Stiffness x delay";
inline constexpr const char* kMaySwing = "Above 8 N s/m the arm may begin to swing in a soft hand.";
inline constexpr const char* kLoopSteps = "Loop";
inline constexpr const char* kLoopTimes = "{} us (p99 {}), {} late";
inline constexpr const char* kSimulatedDevice = "SIMULATED";
inline constexpr const char* kRealDevice = "real";
inline constexpr const char* kDeviceLine = "{}: {}, {} {}";
inline constexpr const char* kForceLimit = "limit";
inline constexpr const char* kFeelFirstOn = "Press the first surface with your finger, then choose Done.";
inline constexpr const char* kFeelSecondOn = "Press the second surface with your finger, then choose Done.";
inline constexpr const char* kPressLightly = "At the limit: press lightly.";
inline constexpr const char* kNoDeeper = "No deeper here: press lightly.";
inline constexpr const char* kDevicePresses = "Press with the device.";
inline constexpr const char* kNoDevicePresses = "No device runs to press with.";
inline constexpr const char* kDevicesMissing = "Missing: {}";
inline constexpr const char* kDevicesStopped = "The devices were stopped: {}. Start releases them and begins again.";

// soft device
inline constexpr const char* kTangible = "Soft device";
inline constexpr const char* kKeyTangible = "G";
inline constexpr const char* kHintTangible =
    "The soft device: its shape, its actuators, wanted and rendered force, the inverse problem";
inline constexpr const char* kNoTangible = "This scene has no soft device.";
inline constexpr const char* kNoSoftDevices =
    "This program drives no soft devices: browsers cannot, and a build without "
    "PALPA_TANGIBLE leaves them out.";
inline constexpr const char* kSoftOpening = "The soft device is getting ready.";
inline constexpr const char* kSoftRuns = "Running";
inline constexpr const char* kSoftHeld = "The last valid command is held.";
inline constexpr const char* kRelaxedDrive = "relaxed";
inline constexpr const char* kSoftRests = "The device is relaxed: no trial is running.";
inline constexpr const char* kSoftStoppedBy = "Stopped: {}. The device is relaxed until you choose Release.";
inline constexpr const char* kSoftRestsSince = "The device is relaxed: {}.";
inline constexpr const char* kSoftStoppedBanner =
    "Stopped: {}. The soft device is relaxed. Press G, or choose Soft device in the menu, to release it.";
inline constexpr const char* kSoftStoppedInStudy = "Stopped: {}. The soft device is relaxed.";
inline constexpr const char* kSoftDeformed = "{}: outline wanted, filled rendered";
inline constexpr const char* kAtLimit = "{} (limit)";
inline constexpr const char* kHeld = "{} (held)";  // at the pretension or by its rate, within the limits
inline constexpr const char* kWantedForce = "Wanted";
inline constexpr const char* kRenderedForce = "Rendered ({})";
inline constexpr const char* kForceError = "Force error";
inline constexpr const char* kForceErrorIs = "{} % rms";
inline constexpr const char* kVirtualDepth = "Virtual depth";
inline constexpr const char* kProxyDepth = "{} (proxy {})";
inline constexpr const char* kActuator = "Actuator";
inline constexpr const char* kActuation = "Actuation";
inline constexpr const char* kLimits = "Limits";
inline constexpr const char* kCommand = "Command";
inline constexpr const char* kCompliance = "W";
inline constexpr const char* kGap = "Gap, actuators at 0";
inline constexpr const char* kGapByActuators = "by the actuators";
inline constexpr const char* kGapLeft = "left (residual)";
inline constexpr const char* kSolve = "Solve";
inline constexpr const char* kSolvedIn = "{}: rank {}, iterations: {}";
inline constexpr const char* kNotConverged = "not converged";
inline constexpr const char* kLimitedBy = "The device cannot render this: {} is at its limit.";
inline constexpr const char* kTicks = "Ticks";
inline constexpr const char* kTicksMissed = "{} done, {} left out (late), {} saturated, held {}\u00a0s";
inline constexpr const char* kPeriod = "Period";
inline constexpr const char* kPeriodTimes = "{} ms (p99 {}), step {} ms (p99 {})";
inline constexpr const char* kVirtualTissue = "Virtual tissue";
inline constexpr const char* kProxyAndFinger = "ring proxy, dot finger";

// device check
inline constexpr const char* kReportedCapabilities = "Reported capabilities";
inline constexpr const char* kNoDevice = "The system lists no pointing device";
inline constexpr const char* kByTimeHeld = "set by time or level, no sensor";
inline constexpr const char* kVerdictGood = "Ready: the {} measures pressure ({} distinct values, {} Hz).";
inline constexpr const char* kVerdictNoSensor =
    "The {} does not measure pressure. Press by holding, or use another device.";
inline constexpr const char* kVerdictFew =
    "The {} has a pressure sensor, {} values so far: press on, lightly, then hard.";
inline constexpr const char* kVerdictTry = "Not tried yet: press in the test area, lightly, then hard.";
inline constexpr const char* kVerdictNone =
    "No connected device reports a pressure sensor. Try one in the test area, or press with the mouse or the keys.";
inline constexpr const char* kVaries = "varies: has a sensor";
inline constexpr const char* kVaryIt = "press lightly, then hard";
inline constexpr const char* kPressure = "Pressure";
inline constexpr const char* kCounts = "Raw counts";
inline constexpr const char* kRate = "Sample rate";
inline constexpr const char* kClockDrift = "Clock drift";
inline constexpr const char* kDelivery = "Delivery";
inline constexpr const char* kTiltAndSize = "Tilt, contact size";
inline constexpr const char* kSamples = "Samples";
inline constexpr const char* kTryHere = "Try each pen and finger here: press lightly, then hard";
inline constexpr const char* kPressureRange = "pressure {} to {}";
inline constexpr const char* kNoPressure = "no pressure";
inline constexpr const char* kLevels = ", {} levels";
inline constexpr const char* kTilt = "tilt";
inline constexpr const char* kContactSize = "contact size";
inline constexpr const char* kAlways = "always {}: no sensor";
inline constexpr const char* kNone = "none";
inline constexpr const char* kValues = "{}, {} values";
inline constexpr const char* kRateAndGap = "{} Hz, longest gap {} ms";
inline constexpr const char* kAtATime = "{} samples at a time, delay {} ms";

// size of the screen
inline constexpr const char* kCardSize = "85.6 x 54.0 mm";
inline constexpr const char* kPxPerMm = "px per mm";
inline constexpr const char* kReset = "Reset";
inline constexpr const char* kNotMeasured = "not measured";
inline constexpr const char* kHoldCard =
    "Hold a bank card against the screen and drag the edge of the frame until it is as large as the card.";
inline constexpr const char* kThisScreen =
    "This screen ({}): {}. Once the scale is known, tissue under the pen is drawn true to size.";

// calibration of pressure
inline constexpr const char* kPoints = "Points";
inline constexpr const char* kPressNumber = "Press";
inline constexpr const char* kCreateProfile = "Create profile";
inline constexpr const char* kPauseRecording = "Pause (resume later)";
inline constexpr const char* kForceOverPressure = "Force vs. pressure (shaded: next target)";
inline constexpr const char* kResiduals = "Residuals (% of force)";
inline constexpr const char* kForceOverArea = "Force vs. contact area (shaded: next target)";
inline constexpr const char* kAreaAxis = "contact area (% of full)";
inline constexpr const char* kContactArea = "Contact area";
inline constexpr const char* kPressureAxis = "pressure (% of full)";
inline constexpr const char* kForceAxis = "force (N)";
inline constexpr const char* kPercentAxis = "%";
inline constexpr const char* kMouseHasNone = "A mouse has no pressure sensor: press with the pen or a finger.";
inline constexpr const char* kHoldStill = "Hold the pen still, type the reading of the scale, and press Enter.";
inline constexpr const char* kRecorded = "Recorded.";
inline constexpr const char* kDropPoint = "Drop the last point";
inline constexpr const char* kNotAForce = "Not recorded: type what the scale shows, 0 to 6118 gram-force.";
inline constexpr const char* kNotRecorded = "Not recorded: press, and hold the pen still at another level.";
inline constexpr const char* kTypedScale = "Scale, readings typed in";
inline constexpr const char* kNetFt = "ATI Net F/T";
inline constexpr const char* kLoadCell = "Load cell, serial port";
inline constexpr const char* kCountsPerN = "counts per N";
inline constexpr const char* kNPerCount = "N per count";
inline constexpr const char* kGiveNPerCount =
    "Type how many newtons one count of the load cell is: put a known weight on it, and divide its newtons by the "
    "difference of the counts.";
inline constexpr const char* kGiveCountsPerN = "Type the counts per newton that the sensor's web page shows.";
inline constexpr const char* kSensorStopped = "The sensor sends nothing; no points are recorded until it is back.";
inline constexpr const char* kGramForce = "gf";
inline constexpr const char* kAddress = "Address";
inline constexpr const char* kPort = "Port";
inline constexpr const char* kName = "Name";
inline constexpr const char* kSavedAs = "Saved as {}; select it in the menu.";
inline constexpr const char* kSensorHealth = "{}: {} readings, {} lost, {} duplicate, {} out of order, {} stalls";
inline constexpr const char* kAfterPress = "After press {}: {}";
inline constexpr const char* kCurveKnown = "The curve is known to 5 % everywhere.";
inline constexpr const char* kHowToCalibrate =
    "Put a force sensor under the tablet, or the tablet on a scale. Then press slowly, hold still, press harder, and "
    "repeat several times.";
inline constexpr const char* kPointsIn = "{} points saved in {}. To add more, start again under the same name.";
inline constexpr const char* kCalibratedOnDesk = "Pressure is calibrated on the desk, which has the force sensors.";
inline constexpr const char* kHowOnDesk =
    "palpa calibrate record records the points, and palpa calibrate fit makes a profile of them. The menu lists the "
    "profiles that ship with the app. They were measured on single devices: another pen of the same model may differ "
    "by half. The logs hold the pressure as the device sent it, so that newtons can be computed later.";
inline constexpr const char* kCurrentProfile = "Current profile: {}";

// maps
inline constexpr const char* kNoMissingData = "No missing data";
inline constexpr const char* kNormal = "Normal force";
inline constexpr const char* kTangentialX = "Tangential force, x";
inline constexpr const char* kTangentialY = "Tangential force, y";
inline constexpr const char* kStiffness = "Stiffness";
inline constexpr const char* kMap = "Map";
inline constexpr const char* kNoMap =
    "There is no map yet. Put folders NAME.map into the folder maps of your data folder.";
inline constexpr const char* kMapsHidden = "Maps and results show where the nodules are. Finish the test first.";
inline constexpr const char* kMmDeep = "at {} mm";
inline constexpr const char* kCellsOf = "{} x {} cells of {} x {} mm";
inline constexpr const char* kDepthsFromTo = "{} depths, {} to {} mm";
inline constexpr const char* kForceFromTo = "Force {} to {} N";
inline constexpr const char* kShareMissing = "Missing data: {} %";
inline constexpr const char* kNotKnown = "not known";
inline constexpr const char* kNoise = "Noise {}; {} forces changed so that all rise with depth";
inline constexpr const char* kNoiseAbout = "about {} mN";
inline constexpr const char* kTangential = "Tangential force: {}";
inline constexpr const char* kIndenter = "Indenter: {}, radius {} mm";
inline constexpr const char* kPlacedNodule = "Nodule {} (placed) at {}, {} mm";
inline constexpr const char* kDetectedNodule = "Nodule {} (detected) at {}, {} mm";
inline constexpr const char* kMmLong = ", {} mm long";
inline constexpr const char* kMmWide = ", {} mm wide";
inline constexpr const char* kNewtonsPerMm = "N/mm";
inline constexpr const char* kAxesInMm = "x, y in mm";
inline constexpr const char* kForceOverDepth = "Force vs. depth";
inline constexpr const char* kDepthAxis = "depth (mm)";
inline constexpr const char* kPointAtMap = "Point at the map; press to pin a curve";
inline constexpr const char* kNormalForce = "Normal force";
inline constexpr const char* kForceAgainstX = "Force opposing +x";
inline constexpr const char* kForceAgainstY = "Force opposing +y";
inline constexpr const char* kAtPlace = "  at {}, {} mm";

// trial: its messages
inline constexpr const char* kOtherWays =
    "Other ways to press: the mouse (hold its button; the wheel sets how hard) and the keys (arrows move, Space "
    "presses).";
inline constexpr const char* kDisconnected = "{} was disconnected.";
inline constexpr const char* kConnected = "{} is connected.";
inline constexpr const char* kHeldPress = "The {} presses harder the longer it is held.";
inline constexpr const char* kReportsNone = "This {} does not report pressure.";
inline constexpr const char* kReportsConstant = "This {} always reports the same pressure: it has no sensor.";
inline constexpr const char* kReplayOf = "Replay of {}";
inline constexpr const char* kNoSensorHere = "No pen or finger with a pressure sensor is connected.";
inline constexpr const char* kNoSensorYet = "No pen or finger with a pressure sensor has touched the screen yet.";
inline constexpr const char* kCannotBeWritten =
    "{}: cannot be written any more, so the trial ends here (is the disk full, or the folder gone?)";
inline constexpr const char* kPreparing = "Preparing the tissue: {} %";
inline constexpr const char* kSaved = "Saved {}";
inline constexpr const char* kDoneWith = "This trial is done with the {}.";
inline constexpr const char* kTouchFirst = "Press this surface first, then say that you are done.";

// the question before marks are thrown away
inline constexpr const char* kLoseMarks = "End this trial?";
inline constexpr const char* kLoseMark = "1 mark is not scored yet. This trial cannot be resumed.";
inline constexpr const char* kLoseManyMarks = "{} marks are not scored yet. This trial cannot be resumed.";
inline constexpr const char* kLoseTrial = "It is logged as interrupted, and repeated when the study continues.";
inline constexpr const char* kLosePair = "End in the middle of this pair?";
inline constexpr const char* kPairRepeated = "The pair was not answered, and is repeated when the study continues.";
inline constexpr const char* kContinuePair = "Continue the pair";
inline constexpr const char* kLeaveAnswers = "Close without these answers?";
inline constexpr const char* kLoseAnswers = "The answers on this page are not saved yet.";
inline constexpr const char* kBackToAnswers = "Back to the answers";
inline constexpr const char* kContinueTrial = "Continue the trial";
inline constexpr const char* kEndTrial = "End the trial";

// study, between its trials
inline constexpr const char* kTrialsOnTablet = "Trials on this tablet";
inline constexpr const char* kCloseStudy = "Close the study";
inline constexpr const char* kPleaseWait = "Please wait";
inline constexpr const char* kBeingStored =
    "Your data are being stored on this tablet. The study continues as soon as they are.";
inline constexpr const char* kParticipantCode = "Participant code";
inline constexpr const char* kCodeNoName =
    "Enter letters and digits, not a name. A participant who returns uses the same code.";
inline constexpr const char* kCode = "code";
inline constexpr const char* kContinueStudy = "Continue the study";
inline constexpr const char* kAnotherParticipant = "Another participant";
inline constexpr const char* kBeforeYouTakePart = "Before you take part";
inline constexpr const char* kAgree = "I agree to take part";
inline constexpr const char* kDoNotAgree = "I do not want to take part";
inline constexpr const char* kWithdraw = "Withdraw from the study";
inline constexpr const char* kWantToWithdraw = "Do you want to withdraw from the study?";
inline constexpr const char* kMayWithdraw =
    "You may withdraw at any time and need not give a reason. You decide whether your data so far may be used.";
inline constexpr const char* kWithdrawKeepsData = "Withdraw; my data may be used";
inline constexpr const char* kWithdrawTakesData = "Withdraw; do not use my data";
inline constexpr const char* kHasWithdrawn = "You have withdrawn from the study. Thank you!";
inline constexpr const char* kCodeHasWithdrawn = "Participant {} has withdrawn.";
inline constexpr const char* kWasRight = "Correct";
inline constexpr const char* kWasWrong = "Incorrect";
inline constexpr const char* kFeedbackFalse = "False positives (marks on no nodule): {}";
inline constexpr const char* kAboutLastTrials = "These questions are about the trials that you have just finished.";
inline constexpr const char* kOnlyInPractice = "You get this feedback only during practice.";
inline constexpr const char* kQuestionsFirst = "About you";
inline constexpr const char* kHowWasIt = "How was it?";
inline constexpr const char* kMayLeaveOpen = "You may skip any question.";
inline constexpr const char* kDigitTooEarly =
    "The digit came before this page could take it: press it again, or Enter to leave the questions open.";
inline constexpr const char* kDeviceMissing = "The {} is not connected";
inline constexpr const char* kDeviceIsBack = "The {} is connected";
inline constexpr const char* kDeviceNoPressure = "The {} does not measure pressure";
inline constexpr const char* kAnswerFull = "No more fits into this answer.";
inline constexpr const char* kNothingFelt = "Nothing could be felt";
inline constexpr const char* kNeedsPressure =
    "This trial needs a pen that measures pressure. Press with it anywhere, lightly, then hard; as soon as its "
    "pressure varies, the trial can start.";
inline constexpr const char* kNeedsFingerPressure =
    "This trial needs a screen that measures how hard a finger presses. Press anywhere, lightly, then hard; as soon as "
    "the pressure varies, the trial can start.";
inline constexpr const char* kDeviceSameArea = "The {} always has the same contact area";
inline constexpr const char* kNeedsContactArea =
    "This trial needs a screen that measures how large the contact of a finger is. Press anywhere, lightly, then hard; "
    "as "
    "soon as the area varies, the trial can start.";
inline constexpr const char* kPressureReady = "Device check: the {} measures pressure.";
inline constexpr const char* kPressureUntried =
    "Device check: press with the {} here, lightly, then hard, to try its pressure.";
inline constexpr const char* kPressureMissing = "Device check: the {} does not measure pressure.";
inline constexpr const char* kTrialWaits =
    "This trial is done with the {}. Connect it or switch it on; the app notices it within a second.";
inline constexpr const char* kNothingTouched = "The time is over";
inline constexpr const char* kTimeOverUnseen =
    "It was over while this app was out of sight, so the trial does not count and is repeated. Choose Start when you "
    "are ready.";
inline constexpr const char* kTimeOverUntouched =
    "Nothing was touched, so nothing is counted, and this part is repeated. Choose Start when you are ready.";
inline constexpr const char* kTrialInterrupted =
    "The trial was interrupted. It is logged as interrupted, does not count, and will be repeated.";
inline constexpr const char* kLeaveAndContinue =
    "You can also leave this page: all finished trials are stored. To continue, open the study again with the same "
    "participant "
    "code.";
inline constexpr const char* kCloseAndContinue =
    "You can also close the study: all finished trials are saved. To continue, run the same command with the same "
    "participant code.";
inline constexpr const char* kFeelFirst = "Feel the first surface.";
inline constexpr const char* kFeelSecond = "Now feel the second surface.";
inline constexpr const char* kWhichSofter = "Which one was softer?";
inline constexpr const char* kTheFirst = "The first";
inline constexpr const char* kTheSecond = "The second";
inline constexpr const char* kMissed = "missed";
inline constexpr const char* kFound = "found";
inline constexpr const char* kStopClock = "Stop the clock";
inline constexpr const char* kRestartClock = "Restart the clock";
inline constexpr const char* kStartClock = "Start the clock";
inline constexpr const char* kTypeAnswers = "The participant palpates the phantom. Type in the answers.";
inline constexpr const char* kNotDriven = "This device is not controlled by the app. Type in the answers.";
inline constexpr const char* kNodulesFound = "nodules found";
inline constexpr const char* kNodulesMissed = "nodules missed";
inline constexpr const char* kFoundAndSure = "Found, and the confidence from 1 (unsure) to 5 (sure).";
inline constexpr const char* kFalsePositiveCount = "false positives";
inline constexpr const char* kThatWasAll = "The study is complete. Thank you!";
inline constexpr const char* kNextParticipant = "Next participant";
inline constexpr const char* kStudyStopped = "The study has stopped";
inline constexpr const char* kBreak = "Time for a break";
inline constexpr const char* kHasTakenPart = "Participant {} has already taken part";
inline constexpr const char* kTrialsDone = "Finished trials: {} of {}. A trial that was interrupted is repeated.";
inline constexpr const char* kEndOfScale = "{} ({})";
inline constexpr const char* kScaleFromTo = "A whole number from {} to {}";
inline constexpr const char* kNumberFromTo = "Enter a number from {} to {}.";
inline constexpr const char* kWholeFromTo = "Enter a whole number from {} to {}.";
inline constexpr const char* kPracticeOf = "Practice, trial {}";
inline constexpr const char* kThereAre = "Number of nodules: {}.";
inline constexpr const char* kTimeOf = "{} of {}";
inline constexpr const char* kTimeOver = "{} of {}: time is up";
inline constexpr const char* kExperimenter = "Experimenter: trial {}, {}";
inline constexpr const char* kAllSaved = "Participant {}: all trials are saved ({}).";
inline constexpr const char* kRestKept =
    "All trials that were finished before are saved. To continue, start the study again with the same participant "
    "code.";
inline constexpr const char* kComesNext = "Next is trial {}. Continue when you are ready.";

// the page around the program, in the browser: cmake/page_words.py hands these to its scripts
inline constexpr const char* pageLoading = "Loading Palpa";
inline constexpr const char* pageLoadingShare = "Loading Palpa: {} %";
inline constexpr const char* pageCloseStudy = "Close the study";
inline constexpr const char* pageYourAnswer = "Your answer";
inline constexpr const char* pageTrials = "Trials on this tablet";
inline constexpr const char* pageCode = "Pairing code (palpa serve shows it on the desk)";
inline constexpr const char* pagePair = "Pair with the desk";
inline constexpr const char* pageSendNow = "Send now";
inline constexpr const char* pageExport = "Export to a file";
inline constexpr const char* pageRemove = "Delete exported trials";
inline constexpr const char* pageClose = "Close";
inline constexpr const char* pageDrivesDevices =
    "On the desk's machine only, since they drive devices or read a pen's counts: {}.";
inline constexpr const char* pageStudies = "Start a study";
inline constexpr const char* pageStudyCode = "Participant code: letters and digits (if empty, the study asks for it)";
inline constexpr const char* pageStart = "Start";
inline constexpr const char* pageStopped = "Palpa has stopped: {}";
inline constexpr const char* pageNotHere = "This study cannot be run here. {}";
inline constexpr const char* pageLooking = "Looking for protocols";
inline constexpr const char* pageRemoveAsk =
    "Delete the exported trials from this tablet? The exported file is then the only copy.";
inline constexpr const char* pageNotLoaded = "the program cannot be loaded; is the desk reachable?";
inline constexpr const char* pageAnswered = "The desk answered {} to {}.";
inline constexpr const char* pageInTheApp = "included in the app";
inline constexpr const char* pageOfDeskStored = "from the desk, stored here";
inline constexpr const char* pageOfDesk = "from the desk";
inline constexpr const char* pageNoDesk =
    "No desk is reachable, or this tablet is not paired (Menu, Trials). Protocols of the desk are missing here unless "
    "they were used before.";
inline constexpr const char* pageNoStorage = "the browser offers no storage to this page";
inline constexpr const char* pageInterrupted = "interrupted";
inline constexpr const char* pageHeldElsewhere = "another page is using it";
inline constexpr const char* pageLost = "{} stored trial(s) are lost: the browser has deleted them ({}).";
inline constexpr const char* pageSecondTab =
    "Palpa is open in another tab or window of this browser; close one of them";
inline constexpr const char* pageStorageClosed =
    "The browser has closed its storage: trials are no longer stored. Export what is there.";
inline constexpr const char* pageCannotStore =
    "This browser cannot store trials ({}). Export each trial when it is finished.";
inline constexpr const char* pageTakesNoLogs = "This desk does not accept logs (it was started without --collect).";
inline constexpr const char* pageNotStored =
    "Trial {} is not stored: {}. Export, on the page of trials, saves it to a file; the next trial waits for that.";
inline constexpr const char* pageCannotRead =
    "The trials that were stored before cannot be read ({}); the exported file does not contain them.";
inline constexpr const char* pageOddParticipant =
    "The page's address names the participant '{}', expected 1 to 64 letters and digits, and none of NA, nan, null, "
    "None, all, total. Trials are stored under {}.";
inline constexpr const char* pageStorageFull = "the storage of this browser is full";
inline constexpr const char* pagePartNotStored =
    "The trial in progress is not stored ({}); this is tried again at its end.";
inline constexpr const char* pagePairAgain = "The desk no longer knows this tablet. Pair it again.";
inline constexpr const char* pageChecksumMismatch =
    "Checksum mismatch: the copy of {} at the desk differs; it is sent again.";
inline constexpr const char* pageTrialsWait = "The desk is not reachable; trials wait here.";
inline constexpr const char* pagePaired = "Paired.";
inline constexpr const char* pageWrongCode = "The desk does not accept this code ({}).";
inline constexpr const char* pageCodesLocked = "Too many wrong codes: the desk looks at no code for {} s.";
inline constexpr const char* pageNotReachable = "The desk is not reachable.";
inline constexpr const char* pageAtDesk = "at the desk";
inline constexpr const char* pageInProgress = "in progress";
inline constexpr const char* pageWaiting = "waiting";
inline constexpr const char* pageInterruptedWaiting = "interrupted, waiting";
inline constexpr const char* pageExported = ", exported";
inline constexpr const char* pageHowMany = "{} waiting, {} at the desk.";
inline constexpr const char* pageIsPaired = "Paired with the desk.";
inline constexpr const char* pageOpenToAll = "The desk accepts logs without a code.";
inline constexpr const char* pageStudyUnpaired =
    "This tablet was not paired with the desk when the study was opened: it is the one stored here, or the app's. "
    "Pair it in Menu, Trials, and open the study again.";
inline constexpr const char* pageStudyUnstored =
    "This browser stores nothing (a private window?): a reload would forget who is here and what is done.";
inline constexpr const char* pageStudyCut =
    "The desk has this study but did not send all of it: the study is the one stored here, or the app's. Open it "
    "again.";
inline constexpr const char* pageNotPaired = "Not paired with a desk.";
inline constexpr const char* pageMayDelete =
    "The browser may delete stored trials when space is short: send or export them, or put Palpa on the home screen.";
inline constexpr const char* pageExportIt = "NOT stored: export it";
inline constexpr const char* pageStoredUnsent = "Stored on this tablet, not yet at the desk: {} (trials and answers).";
inline constexpr const char* pageStored = "Stored on this tablet: {} (trials and answers).";
inline constexpr const char* pageTheyAreHere = "The trials are on this tablet.";
inline constexpr const char* pageTheyAreAtDesk = "The trials are at the desk.";
inline constexpr const char* pageSomeAreHere =
    "Some trials are on this tablet, the others at the desk or in an exported file.";
inline constexpr const char* pageAnswersAreHere = "Answers are still on this tablet.";
inline constexpr const char* pageNoneIsHere = "The trials are at the desk or in an exported file.";
inline constexpr const char* pageAllSafe = "All trials are at the desk or exported.";
inline constexpr const char* pageStoredHere = "Trials are stored on this tablet.";
inline constexpr const char* pageSettingsNotStored = "Settings are not stored: the storage of this browser is full.";
inline constexpr const char* pageUnsaved = "NOT stored: {} (trials and answers). Use Export.";
inline constexpr const char* pageDesignNotStored =
    "The changed part is not stored: {}. Save it to a file before you leave this page.";
inline constexpr const char* pageCanvas = "Tissue to press on, and its controls";

}  // namespace palpa::app::words
