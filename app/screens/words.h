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
inline constexpr const char* kGoOn = "Go on";
inline constexpr const char* kBegin = "Begin";
inline constexpr const char* kKeep = "Keep";
inline constexpr const char* kFelt = "Felt";

// menu
inline constexpr const char* kTrial = "Trial";
inline constexpr const char* kPractice = "Practice";
inline constexpr const char* kTest = "Test";
inline constexpr const char* kBeginAnew = "Begin anew";
inline constexpr const char* kDrawingHand = "Drawing hand";
inline constexpr const char* kLeft = "Left";
inline constexpr const char* kRight = "Right";
inline constexpr const char* kSideView = "Side view";
inline constexpr const char* kAvatarOfFinger = "A finger's avatar";
inline constexpr const char* kUnderIt = "Under it";
inline constexpr const char* kAboveIt = "Above it";
inline constexpr const char* kScreenAndDevices = "Screen and devices";
inline constexpr const char* kSizeOfScreen = "Size of the screen";
inline constexpr const char* kDeviceCheck = "Device check";
inline constexpr const char* kCalibratePressure = "Calibrate pressure";
inline constexpr const char* kMaps = "Maps";
inline constexpr const char* kCost = "Cost";
inline constexpr const char* kFullScreen = "Full screen";
inline constexpr const char* kTrials = "Trials";
inline constexpr const char* kQuit = "Quit";
inline constexpr const char* kScene = "Scene";
inline constexpr const char* kPressureProfile = "Pressure profile";
inline constexpr const char* kOnThisTablet = "On this tablet";
inline constexpr const char* kStudies = "Studies";

// cost of every stage
inline constexpr const char* kStage = "stage";
inline constexpr const char* kFidelity = "fidelity";
inline constexpr const char* kError = "error";
inline constexpr const char* kMicroseconds = "us";
inline constexpr const char* kMicroseconds99 = "us, 99 %";
inline constexpr const char* kCalls = "calls";
inline constexpr const char* kFrameTimes =
    "Sample to frame {} ms (99 %: {}), besides drawing {} ms. Frame {} ms besides drawing (99 %: {}), drawing {} ms. "
    "{} "
    "frames/s, {} samples, {} steps dropped, {} along fast strokes skipped.";

// trial
inline constexpr const char* kForce = "Force";
inline constexpr const char* kDepth = "Depth";
inline constexpr const char* kLag = "Lag";
inline constexpr const char* kDelay = "Delay";
inline constexpr const char* kPhantom = "Phantom";
inline constexpr const char* kDeeperThanKnown = "deeper than known";
inline constexpr const char* kNotMeasuredHere = "not measured here";
inline constexpr const char* kBeyondLinear = "beyond the linear range";
inline constexpr const char* kLeavingLinear = "leaving the linear range";
inline constexpr const char* kFirstSurface = "First surface";
inline constexpr const char* kSecondSurface = "Second surface";
inline constexpr const char* kWithNodules = "practice";
inline constexpr const char* kWithoutNodules = "test";
inline constexpr const char* kUnsure = "unsure";
inline constexpr const char* kSure = "sure";
inline constexpr const char* kUndo = "Undo";
inline constexpr const char* kFinish = "Finish";
inline constexpr const char* kUnderstood = "Understood";
inline constexpr const char* kPressByHolding = "Press by holding";
inline constexpr const char* kAnalyticTissue = "Tissue: analytic stand-in, no recording";
inline constexpr const char* kSimulatedTissue = "Tissue: simulated, no recording";
inline constexpr const char* kTooSmall = "Too small for the controls; keys work";
inline constexpr const char* kLight = "light";
inline constexpr const char* kMedium = "medium";
inline constexpr const char* kDeep = "deep";
inline constexpr const char* kPairOf = "Pair {}";
inline constexpr const char* kTrialOf = "Trial {}";
inline constexpr const char* kMark = "Mark  {}";
inline constexpr const char* kWithoutLevel = "This device reports no {}, which profile {} reads.";
inline constexpr const char* kShownAt = "Tissue shown at {} % of its size";

// results of a trial
inline constexpr const char* kSensitivity = "Sensitivity";
inline constexpr const char* kPpv = "PPV";
inline constexpr const char* kFalseMarks = "False marks";
inline constexpr const char* kTime = "Time";
inline constexpr const char* kAreaExamined = "Area examined";
inline constexpr const char* kAgain = "Again";
inline constexpr const char* kNext = "Next";
inline constexpr const char* kSavePicture = "Save picture";
inline constexpr const char* kNotTouched = "not touched";
inline constexpr const char* kLightOrDeeper = "light or deeper";
inline constexpr const char* kMediumOrDeeper = "medium or deeper";
inline constexpr const char* kFoundNodule = "{}: found";
inline constexpr const char* kMissedNodule = "{}: missed";
inline constexpr const char* kMarkAgain = "{} again";
inline constexpr const char* kMarkFalse = "{} false";
inline constexpr const char* kFoundOf = "Found {} of {}";
inline constexpr const char* kDownTo = ", down to {} mm";

// device check
inline constexpr const char* kSaysItHas = "Says that it has";
inline constexpr const char* kNoDevice = "no device that the system tells us about";
inline constexpr const char* kByTimeHeld = "by time held or level set, no sensor";
inline constexpr const char* kVaries = "varies: a sensor";
inline constexpr const char* kVaryIt = "vary it for a second";
inline constexpr const char* kPressure = "Pressure";
inline constexpr const char* kCounts = "Counts";
inline constexpr const char* kRate = "Rate";
inline constexpr const char* kClockDrift = "Clock drift";
inline constexpr const char* kDelivered = "Delivered";
inline constexpr const char* kTiltAndSize = "Tilt, size";
inline constexpr const char* kSamples = "Samples";
inline constexpr const char* kTryHere = "Try pen and fingers here: press lightly, then hard";
inline constexpr const char* kPressureRange = "pressure {} ... {}";
inline constexpr const char* kNoPressure = "no pressure";
inline constexpr const char* kLevels = ", {} levels";
inline constexpr const char* kTilt = "tilt";
inline constexpr const char* kContactSize = "contact size";
inline constexpr const char* kAlways = "always {}: no sensor";
inline constexpr const char* kNone = "none";
inline constexpr const char* kValues = "{}, {} values";
inline constexpr const char* kRateAndGap = "{} Hz, worst gap {} ms";
inline constexpr const char* kAtATime = "{} at a time, {} ms late";

// size of the screen
inline constexpr const char* kCardSize = "85.6 x 54.0 mm";
inline constexpr const char* kPxPerMm = "px per mm";
inline constexpr const char* kForget = "Forget";
inline constexpr const char* kNotMeasured = "not measured";
inline constexpr const char* kHoldCard = "Hold a bank card against the screen and make the frame as large as the card.";
inline constexpr const char* kThisScreen =
    "This screen ({}): {}. Where it is known, tissue under the pen is drawn true to size.";

// calibration of pressure
inline constexpr const char* kPoints = "Points";
inline constexpr const char* kPress = "Press";
inline constexpr const char* kMakeProfile = "Make the profile";
inline constexpr const char* kStopRecording = "Stop (can be continued)";
inline constexpr const char* kForceOverPressure = "Force over pressure; tinted: press here next";
inline constexpr const char* kResiduals = "What is left without the curve, share of the force";
inline constexpr const char* kHoldStill = "Hold the pen still, type what the scale shows, then take it.";
inline constexpr const char* kTake = "Take";
inline constexpr const char* kTaken = "Taken.";
inline constexpr const char* kNotTaken = "Not taken: hold the pen still at another level.";
inline constexpr const char* kTypedScale = "Scale, typed by hand";
inline constexpr const char* kNetFt = "ATI Net F/T";
inline constexpr const char* kLoadCell = "Load cell, serial port";
inline constexpr const char* kCountsPerN = "counts per N";
inline constexpr const char* kNPerCount = "N per count";
inline constexpr const char* kSensorStopped = "The sensor has stopped; nothing is captured until it is back.";
inline constexpr const char* kStart = "Start";
inline constexpr const char* kGramForce = "gf";
inline constexpr const char* kAddress = "address";
inline constexpr const char* kPort = "port";
inline constexpr const char* kName = "name";
inline constexpr const char* kKeptAs = "Kept as {}; choose it in the menu.";
inline constexpr const char* kSensorHealth = "{}: {} readings, lost {}, twice {}, late {}, stalls {}";
inline constexpr const char* kCurveKnown = "The curve is known to 5 % everywhere.";
inline constexpr const char* kHowToCalibrate =
    "Put a force sensor under the tablet, or the tablet on a scale. Then press slowly, hold still, press harder, "
    "several "
    "times.";
inline constexpr const char* kPointsIn = "Points: {}, in {}. The same name continues them.";
inline constexpr const char* kCalibratedOnDesk = "Pressure is calibrated on the desk, which has the force sensors.";
inline constexpr const char* kHowOnDesk =
    "palpa calibrate record takes the points and palpa calibrate fit makes a profile of them. Profiles that are "
    "shipped "
    "with the app stand in the menu. They were measured on single devices: another pen of the same model may differ by "
    "half, and the logs hold the pressure as the device sent it, so that newtons can be worked out later.";
inline constexpr const char* kProfileNow = "Profile now: {}";

// maps
inline constexpr const char* kMeasuredEverywhere = "Measured everywhere";
inline constexpr const char* kNormal = "Normal";
inline constexpr const char* kSidewaysX = "Sideways x";
inline constexpr const char* kSidewaysY = "Sideways y";
inline constexpr const char* kStiffness = "Stiffness";
inline constexpr const char* kMap = "Map";
inline constexpr const char* kNoMap = "There is no map here: put NAME.map folders into your data folder's maps";
inline constexpr const char* kMapsHidden = "Maps show where nodules are: finish the test first.";
inline constexpr const char* kMmDeep = "{} mm deep";
inline constexpr const char* kCellsOf = "{} x {} cells of {} x {} mm";
inline constexpr const char* kDepthsFromTo = "{} depths, {} to {} mm";
inline constexpr const char* kForceFromTo = "Force {} to {} N";
inline constexpr const char* kShareMissing = "Not measured: {} %";
inline constexpr const char* kNoise = "Noise {} mN; {} forces do not rise with depth";
inline constexpr const char* kTangential = "Tangential force: {}";
inline constexpr const char* kIndenter = "Indenter: {}, radius {} mm";
inline constexpr const char* kPlacedNodule = "Nodule {} (placed) at {}, {} mm";
inline constexpr const char* kDetectedNodule = "Nodule {} (detected) at {}, {} mm";
inline constexpr const char* kMmLong = ", {} mm long";
inline constexpr const char* kMmWide = ", {} mm wide";
inline constexpr const char* kNewtonsPerMm = "N/mm";
inline constexpr const char* kAxesInMm = "x, y in mm";
inline constexpr const char* kForceOverDepth = "Force over depth";
inline constexpr const char* kDepthAxis = "depth (mm)";
inline constexpr const char* kPointAtMap = "Point at the map; a press pins a curve";
inline constexpr const char* kNormalForce = "Normal force";
inline constexpr const char* kForceAgainstX = "Force against +x";
inline constexpr const char* kForceAgainstY = "Force against +y";
inline constexpr const char* kAtPlace = "  at {}, {} mm";

// trial: its messages
inline constexpr const char* kOtherWays =
    "Other ways to press: the mouse (hold its button, or turn the wheel) and the keys (arrows move, Space presses).";
inline constexpr const char* kIsGone = "{} is gone.";
inline constexpr const char* kIsHere = "{} is here.";
inline constexpr const char* kHeldPress = "The {} presses harder the longer it is held.";
inline constexpr const char* kReportsNone = "This {} reports no pressure.";
inline constexpr const char* kReportsConstant = "This {} reports always the same pressure: it has no sensor.";
inline constexpr const char* kReplayOf = "Replay of {}";
inline constexpr const char* kNoSensorHere = "No pen or finger with a pressure sensor here.";
inline constexpr const char* kCannotBeWritten = "{}: can no longer be written; stopped (is the disk full?)";
inline constexpr const char* kPreparing = "Preparing the tissue (once; later starts are quick)";
inline constexpr const char* kSaved = "Saved {}";
inline constexpr const char* kDoneWith = "This trial is done with the {}.";

// the question before marks are thrown away
inline constexpr const char* kLoseMarks = "End this trial?";
inline constexpr const char* kLoseMark =
    "1 mark stands on the tissue and nothing is scored yet. This trial cannot be continued.";
inline constexpr const char* kLoseManyMarks =
    "{} marks stand on the tissue and nothing is scored yet. This trial cannot be continued.";
inline constexpr const char* kLeaveAnswers = "Close without these answers?";
inline constexpr const char* kLoseAnswers = "The answers on this page are not kept yet.";
inline constexpr const char* kBackToAnswers = "Back to the answers";
inline constexpr const char* kGoOnWithTrial = "Go on with the trial";
inline constexpr const char* kEndTrial = "End it";

// study, between its trials
inline constexpr const char* kTrialsOnTablet = "Trials on this tablet";
inline constexpr const char* kLeaveStudy = "Leave the study";
inline constexpr const char* kOneMoment = "One moment";
inline constexpr const char* kBeingKept =
    "What was done is being put into this tablet's storage. The study goes on when it is there.";
inline constexpr const char* kWhoIsHere = "Who is here?";
inline constexpr const char* kCodeNoName =
    "A code for the participant, no name: letters and digits. Whoever was here before goes on with the same code.";
inline constexpr const char* kCode = "code";
inline constexpr const char* kGoOnWithStudy = "Go on with the study";
inline constexpr const char* kSomebodyElse = "Somebody else";
inline constexpr const char* kBeforeYouTakePart = "Before you take part";
inline constexpr const char* kAgree = "I agree and take part";
inline constexpr const char* kDoNotAgree = "I do not take part";
inline constexpr const char* kStopTakingPart = "Stop taking part";
inline constexpr const char* kWantToStop = "Do you want to stop taking part?";
inline constexpr const char* kMayStop =
    "You may stop at any time, without giving a reason. What you did so far may be used for the study, or is left out "
    "of it.";
inline constexpr const char* kStopKeepsData = "Stop; what I did may be used";
inline constexpr const char* kStopTakesData = "Stop; leave out what I did";
inline constexpr const char* kHasStopped = "You have left the study. Thank you!";
inline constexpr const char* kCodeHasLeft = "Participant {} takes part no longer.";
inline constexpr const char* kWasRight = "That was right";
inline constexpr const char* kWasWrong = "That was not right";
inline constexpr const char* kOnlyInPractice = "You are told this only in practice.";
inline constexpr const char* kQuestionsFirst = "Some questions first";
inline constexpr const char* kHowWasIt = "How was it?";
inline constexpr const char* kMayLeaveOpen = "You may leave any of them open.";
inline constexpr const char* kDeviceMissing = "The {} is not connected";
inline constexpr const char* kDeviceIsBack = "The {} is connected";
inline constexpr const char* kTrialWaits =
    "This trial is done with the {}. Connect it or switch it on: it is noticed within a second.";
inline constexpr const char* kTrialBrokenOff =
    "The trial that was going on was interrupted. It is logged as interrupted, counts as no answer, and begins anew.";
inline constexpr const char* kCloseAndGoOn =
    "Or close the study: everything that was finished is on the disk, and the same command goes on here with the same "
    "code.";
inline constexpr const char* kFeelFirst = "Feel the first surface.";
inline constexpr const char* kFeelSecond = "Now feel the second surface.";
inline constexpr const char* kWhichSofter = "Which one was softer?";
inline constexpr const char* kTheFirst = "The first";
inline constexpr const char* kTheSecond = "The second";
inline constexpr const char* kMissed = "missed";
inline constexpr const char* kFound = "found";
inline constexpr const char* kStopClock = "Stop the clock";
inline constexpr const char* kStartClockAnew = "Start the clock anew";
inline constexpr const char* kStartClock = "Start the clock";
inline constexpr const char* kTypeWhatWasSaid = "The participant palpates the phantom; type what was said.";
inline constexpr const char* kNotDriven = "This device is not driven from here; type what was said.";
inline constexpr const char* kNodulesFound = "nodules found";
inline constexpr const char* kNodulesMissed = "nodules missed";
inline constexpr const char* kFoundAndSure = "Found, and how sure: 1 unsure to 5 sure.";
inline constexpr const char* kFalseMarkCount = "marks on no nodule";
inline constexpr const char* kThatWasAll = "That was all. Thank you!";
inline constexpr const char* kNextParticipant = "Next participant";
inline constexpr const char* kStudyStops = "The study stops here";
inline constexpr const char* kBreak = "Time for a break";
inline constexpr const char* kHasBeenHere = "Participant {} has been here";
inline constexpr const char* kTrialsDone = "{} of {} trials are done. A trial that was interrupted is done once more.";
inline constexpr const char* kNumberFromTo = "A number from {} to {}.";
inline constexpr const char* kPracticeOf = "Practice, trial {}";
inline constexpr const char* kThereAre = "There are {} of them.";
inline constexpr const char* kTimeOf = "{} of {}";
inline constexpr const char* kTimeOver = "{} of {}: the time is over";
inline constexpr const char* kExperimenter = "Experimenter: trial {}, {}";
inline constexpr const char* kAllOnTablet = "Participant {}: {} trials, all kept on this tablet.";
inline constexpr const char* kAllOnDisk = "Participant {}: {} trials, all on the disk.";
inline constexpr const char* kRestKept =
    "Everything that was finished before is kept. Start the study again with the same code to go on.";
inline constexpr const char* kRestOnDisk =
    "Everything that was finished before is on the disk. Start the study again with the same code to go on.";
inline constexpr const char* kComesNext = "Trial {} comes next. Go on when you like.";

// the page around the program, in the browser: cmake/page_words.py hands these to its scripts
inline constexpr const char* pageLoading = "Loading Palpa";
inline constexpr const char* pageLeaveStudy = "Leave the study";
inline constexpr const char* pageYourAnswer = "Your answer";
inline constexpr const char* pageTrials = "Trials on this tablet";
inline constexpr const char* pageCode = "Code that the desk shows (palpa serve)";
inline constexpr const char* pagePair = "Pair with the desk";
inline constexpr const char* pageSendNow = "Send now";
inline constexpr const char* pageExport = "Export to one file";
inline constexpr const char* pageRemove = "Remove what was exported";
inline constexpr const char* pageClose = "Close";
inline constexpr const char* pageStudies = "A study by its protocol";
inline constexpr const char* pageStudyCode = "Code of the participant: letters and digits; empty: it is asked for";
inline constexpr const char* pageBegin = "Begin";
inline constexpr const char* pageStopped = "Palpa has stopped: {}";
inline constexpr const char* pageNotHere = "This study cannot be run here. {}";
inline constexpr const char* pageLooking = "Looking for protocols";
inline constexpr const char* pageRemoveAsk =
    "Remove the exported trials from this tablet? The file that was exported is then the only copy.";
inline constexpr const char* pageNotLoaded = "the program cannot be loaded; is the desk reachable?";
inline constexpr const char* pageAnswered = "The desk answered {} to {}.";
inline constexpr const char* pageInTheApp = "in the app";
inline constexpr const char* pageOfDeskKept = "of the desk, kept here";
inline constexpr const char* pageOfDesk = "of the desk";
inline constexpr const char* pageNoDesk =
    "No desk is reachable, or this tablet is not paired (Menu, Trials): its protocols are missing here unless they "
    "were "
    "used before.";
inline constexpr const char* pageNoStorage = "the browser has no storage for this page";
inline constexpr const char* pageInterrupted = "broken off";
inline constexpr const char* pageHeldElsewhere = "another page holds it";
inline constexpr const char* pageGone = "{} trial(s) that were kept here are gone: the browser has removed them ({}).";
inline constexpr const char* pageSecondTab =
    "Palpa is open in another tab or window of this browser; close one of them";
inline constexpr const char* pageStorageClosed =
    "The browser has closed its storage: trials are not kept any more. Export what is there.";
inline constexpr const char* pageCannotKeep = "Trials cannot be kept in this browser ({}): export each one after it.";
inline constexpr const char* pageTakesNoLogs = "This desk takes no logs (it was started without --collect).";
inline constexpr const char* pageNotKept =
    "Trial {} is not kept: {}. Menu, Trials, Export saves it to a file; the next trial waits for that.";
inline constexpr const char* pageCannotRead =
    "The trials that were kept before cannot be read ({}): the exported file is without them.";
inline constexpr const char* pageOddParticipant =
    "The page's address names the participant '{}', expected 1 to 64 letters and digits: trials are kept as those of "
    "{}.";
inline constexpr const char* pageStorageFull = "the storage of this browser is full";
inline constexpr const char* pagePartNotKept =
    "While it is going on this trial is not kept ({}); it will be tried at its end.";
inline constexpr const char* pagePairAgain = "The desk does not know this tablet any more: pair again.";
inline constexpr const char* pageOtherBytes = "The desk has other bytes of {}; it is sent again.";
inline constexpr const char* pageTrialsWait = "The desk is not reachable; trials wait here.";
inline constexpr const char* pagePaired = "Paired.";
inline constexpr const char* pageWrongCode = "The desk does not take this code ({}).";
inline constexpr const char* pageNotReachable = "The desk is not reachable.";
inline constexpr const char* pageAtDesk = "at the desk";
inline constexpr const char* pageGoingOn = "going on";
inline constexpr const char* pageWaiting = "waiting";
inline constexpr const char* pageBrokenOff = "broken off, waiting";
inline constexpr const char* pageExported = ", exported";
inline constexpr const char* pageHowMany = "{} waiting, {} at the desk.";
inline constexpr const char* pageIsPaired = "Paired with the desk.";
inline constexpr const char* pageOpenToAll = "The desk takes logs without a code.";
inline constexpr const char* pageNotPaired = "Not paired with a desk.";
inline constexpr const char* pageMayRemove =
    "The browser may remove what is kept here when space is short: send or export, or put Palpa on the home screen.";
inline constexpr const char* pageExportIt = "NOT kept: export it";
inline constexpr const char* pageKeptUnsent = "{} trial(s) kept on this tablet, not yet at the desk.";
inline constexpr const char* pageKept = "{} trial(s) kept on this tablet.";
inline constexpr const char* pageAllSafe = "All trials are at the desk or exported.";
inline constexpr const char* pageKeptHere = "Trials are kept on this tablet.";
inline constexpr const char* pageSettingsNotKept = "Settings are not kept: the storage of this browser is full.";
inline constexpr const char* pageUnsaved = "{} trial(s) NOT kept: Menu, Trials, Export.";
inline constexpr const char* pageCanvas = "Tissue to press on, and its controls";

}  // namespace palpa::app::words
