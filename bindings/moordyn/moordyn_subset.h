/* The C functions of libmoordyn as moorline has them: names, parameters and meanings are facts of MoorDyn's interface, the words are
   moorline's. A program that includes MoorDyn's own headers needs this file no more than one that includes this needs MoorDyn's.

   Forces are those of the mooring on what holds it, in N and N m along global axes, z up, still water at z = 0. Arrays of the program:
   x, xd and f hold six numbers for each coupled body, then six for each coupled rod, then three for each coupled point, in the order of
   the file. Every function returns one of the numbers below and says why on the standard error, or in the log. */
#ifndef MOORLINE_MOORDYN_SUBSET_H
#define MOORLINE_MOORDYN_SUBSET_H

#include <stddef.h>
#include <stdint.h>

#define MOORDYN_SUCCESS 0
#define MOORDYN_INVALID_INPUT_FILE -1
#define MOORDYN_INVALID_OUTPUT_FILE -2
#define MOORDYN_INVALID_INPUT -3
#define MOORDYN_NAN_ERROR -4
#define MOORDYN_MEM_ERROR -5
#define MOORDYN_INVALID_VALUE -6
#define MOORDYN_NON_IMPLEMENTED -7
#define MOORDYN_UNHANDLED_ERROR -255

#define MOORDYN_DBG_LEVEL 0
#define MOORDYN_MSG_LEVEL 1
#define MOORDYN_WRN_LEVEL 2
#define MOORDYN_ERR_LEVEL 3
#define MOORDYN_NO_OUTPUT 4096

#ifdef __cplusplus
extern "C" {
#endif

/* Handles: looked up, never followed. One that was closed is found out. */
typedef struct moorline_system *MoorDyn;
typedef struct moorline_line *MoorDynLine;
typedef struct moorline_point *MoorDynPoint;
typedef struct moorline_body *MoorDynBody;
typedef struct moorline_rod *MoorDynRod;
typedef struct moorline_waves *MoorDynWaves;
typedef struct moorline_seafloor *MoorDynSeafloor;

/* The mooring. */
/* Creates a mooring; NULL where that is not possible. */
MoorDyn MoorDyn_Create(const char *path);
/* Number of degrees of freedom that the program moves. */
int MoorDyn_NCoupledDOF(MoorDyn system, unsigned int *n);
/* From which level on the terminal gets messages. */
int MoorDyn_SetVerbosity(MoorDyn system, int level);
/* The file that gets messages. */
int MoorDyn_SetLogFile(MoorDyn system, const char *path);
/* From which level on the file gets messages. */
int MoorDyn_SetLogLevel(MoorDyn system, int level);
/* Tells something to the log. */
int MoorDyn_Log(MoorDyn system, int level, const char *message);
/* Puts the mooring in equilibrium. */
int MoorDyn_Init(MoorDyn system, const double *x, const double *xd);
/* Puts the lines in equilibrium, and lets free bodies and points go where the file has them. */
int MoorDyn_Init_NoIC(MoorDyn system, const double *x, const double *xd);
/* Goes on by a step. */
int MoorDyn_Step(MoorDyn system, const double *x, const double *xd, double *f, double *t, double *dt);
/* Lets go of the mooring; its handle and those of its parts are of nothing from then on. */
int MoorDyn_Close(MoorDyn system);
/* The water. */
MoorDynWaves MoorDyn_GetWaves(MoorDyn system);
/* The bed; NULL where the depth is one number, as MoorDyn has it. */
MoorDynSeafloor MoorDyn_GetSeafloor(MoorDyn system);
/* Number of bodies. */
int MoorDyn_GetNumberBodies(MoorDyn system, unsigned int *n);
/* A body, counted from 1. */
MoorDynBody MoorDyn_GetBody(MoorDyn system, unsigned int number);
/* Number of rods. */
int MoorDyn_GetNumberRods(MoorDyn system, unsigned int *n);
/* A rod, counted from 1. */
MoorDynRod MoorDyn_GetRod(MoorDyn system, unsigned int number);
/* Number of points. */
int MoorDyn_GetNumberPoints(MoorDyn system, unsigned int *n);
/* A point, counted from 1. */
MoorDynPoint MoorDyn_GetPoint(MoorDyn system, unsigned int number);
/* Number of lines. */
int MoorDyn_GetNumberLines(MoorDyn system, unsigned int *n);
/* A line, counted from 1. */
MoorDynLine MoorDyn_GetLine(MoorDyn system, unsigned int number);
/* Horizontal and vertical forces of the first lines at end B, the fairlead, and end A, the anchor. */
int MoorDyn_GetFASTtens(MoorDyn system, const int *count, float *fairlead_across, float *fairlead_up, float *anchor_across, float *anchor_up);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_BreakLine(MoorDyn system, MoorDynPoint point, MoorDynLine line);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetDt(MoorDyn system, double *dt);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetDt(MoorDyn system, double dt);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetCFL(MoorDyn system, double *cfl);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetCFL(MoorDyn system, double cfl);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetTimeScheme(MoorDyn system, char *name, size_t *length);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetTimeScheme(MoorDyn system, const char *name);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SaveVTK(MoorDyn system, const char *path);
/* Writes the state to a file. */
int MoorDyn_Save(MoorDyn system, const char *path);
/* Goes back to the state of a file. */
int MoorDyn_Load(MoorDyn system, const char *path);
/* As MoorDyn_Save. */
int MoorDyn_SaveState(MoorDyn system, const char *path);
/* As MoorDyn_Load. */
int MoorDyn_LoadState(MoorDyn system, const char *path);
/* The state: how many bytes it has, and where there is a place for them, these. */
int MoorDyn_Serialize(MoorDyn system, size_t *size, uint64_t *data);
/* Goes back to a state. */
int MoorDyn_Deserialize(MoorDyn system, const uint64_t *data);
/* No place of the water waits for motions; where the file says that some do, this is a failure. */
int MoorDyn_ExternalWaveKinInit(MoorDyn system, unsigned int *n);
/* As MoorDyn_ExternalWaveKinInit. */
int MoorDyn_ExternalWaveKinGetN(MoorDyn system, unsigned int *n);
/* As MoorDyn_ExternalWaveKinInit. */
int MoorDyn_ExternalWaveKinGetCoordinates(MoorDyn system, double *r);
/* As MoorDyn_ExternalWaveKinInit. */
int MoorDyn_ExternalWaveKinSet(MoorDyn system, const double *u, const double *ud, double t);
/* The older name. */
int MoorDyn_GetWaveKinCoordinates(MoorDyn system, double *r);
/* The older name. */
int MoorDyn_SetWaveKin(MoorDyn system, const double *u, const double *ud, double t);

/* Lines. Node 0 is end A, the anchor; the last is end B, the fairlead. */
/* Its number in the file. */
int MoorDyn_GetLineID(MoorDynLine line, int *id);
/* Number of segments. */
int MoorDyn_GetLineN(MoorDynLine line, unsigned int *n);
/* Number of nodes. */
int MoorDyn_GetLineNumberNodes(MoorDynLine line, unsigned int *n);
/* Unstretched length [m]. */
int MoorDyn_GetLineUnstretchedLength(MoorDynLine line, double *length);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetLineUnstretchedLength(MoorDynLine line, double length);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetLineUnstretchedLengthVel(MoorDynLine line, double rate);
/* Whether EA is one number. */
int MoorDyn_IsLineConstantEA(MoorDynLine line, int *b);
/* EA [N]. */
int MoorDyn_GetLineConstantEA(MoorDynLine line, double *ea);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetLineConstantEA(MoorDynLine line, double ea);
/* Pressure never bends a line here. */
int MoorDyn_IsLinePressBend(MoorDynLine line, int *b);
/* Off is what it is; on has no meaning here. */
int MoorDyn_SetLinePressBend(MoorDynLine line, int b);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SetLinePressInt(MoorDynLine line, const double *p);
/* Position of a node [m]. */
int MoorDyn_GetLineNodePos(MoorDynLine line, unsigned int node, double *to);
/* Velocity of a node [m/s]. */
int MoorDyn_GetLineNodeVel(MoorDynLine line, unsigned int node, double *to);
/* Net force on a node [N]: of an end, that on what holds it. */
int MoorDyn_GetLineNodeForce(MoorDynLine line, unsigned int node, double *to);
/* Tension at a node, in the direction from end A to end B [N]. */
int MoorDyn_GetLineNodeTen(MoorDynLine line, unsigned int node, double *to);
/* Weight and buoyancy of the lump of a node [N]. */
int MoorDyn_GetLineNodeWeight(MoorDynLine line, unsigned int node, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetLineNodeBendStiff(MoorDynLine line, unsigned int node, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetLineNodeDrag(MoorDynLine line, unsigned int node, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetLineNodeFroudeKrilov(MoorDynLine line, unsigned int node, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetLineNodeSeabedForce(MoorDynLine line, unsigned int node, double *to);
/* Curvature at a node [1/m]; 0 of a line that does not resist bending, as MoorDyn has it. */
int MoorDyn_GetLineNodeCurv(MoorDynLine line, unsigned int node, double *to);
/* Mass of the lump of a node with the water that moves with it [kg]. */
int MoorDyn_GetLineNodeM(MoorDynLine line, unsigned int node, double *to);
/* Tension at end B, the fairlead [N]. */
int MoorDyn_GetLineFairTen(MoorDynLine line, double *to);
/* Largest tension along the line [N]. */
int MoorDyn_GetLineMaxTen(MoorDynLine line, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SaveLineVTK(MoorDynLine line, const char *path);

/* Points. */
/* Its number in the file. */
int MoorDyn_GetPointID(MoorDynPoint point, int *to);
/* -1 coupled, 0 free, 1 fixed, also to a body. */
int MoorDyn_GetPointType(MoorDynPoint point, int *to);
/* Position [m]. */
int MoorDyn_GetPointPos(MoorDynPoint point, double *to);
/* Velocity [m/s]. */
int MoorDyn_GetPointVel(MoorDynPoint point, double *to);
/* Force of the lines on it, with its weight, buoyancy, drag and constant force [N]. */
int MoorDyn_GetPointForce(MoorDynPoint point, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetPointM(MoorDynPoint point, double *to);
/* Number of ends of lines on it. */
int MoorDyn_GetPointNAttached(MoorDynPoint point, unsigned int *to);
/* A line on it, counted from 0, and which of its ends: 0 end A, 1 end B. */
int MoorDyn_GetPointAttached(MoorDynPoint point, unsigned int number, MoorDynLine *to, int *end);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SavePointVTK(MoorDynPoint point, const char *path);

/* Bodies. */
/* Its number in the file. */
int MoorDyn_GetBodyID(MoorDynBody body, int *to);
/* -1 coupled, 0 free, 1 fixed. */
int MoorDyn_GetBodyType(MoorDynBody body, int *to);
/* Position and angles, and velocity and angular velocity. */
int MoorDyn_GetBodyState(MoorDynBody body, double *r, double *rd);
/* Position [m]. */
int MoorDyn_GetBodyPos(MoorDynBody body, double *to);
/* Angles [rad]. */
int MoorDyn_GetBodyAngle(MoorDynBody body, double *to);
/* Velocity [m/s]. */
int MoorDyn_GetBodyVel(MoorDynBody body, double *to);
/* Angular velocity [rad/s]. */
int MoorDyn_GetBodyAngVel(MoorDynBody body, double *to);
/* Force and moment about its reference point: of the lines, with its weight and buoyancy [N, N·m]. */
int MoorDyn_GetBodyForce(MoorDynBody body, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetBodyM(MoorDynBody body, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SaveBodyVTK(MoorDynBody body, const char *path);

/* Rods. Node 0 is end A. */
/* Its number in the file. */
int MoorDyn_GetRodID(MoorDynRod rod, int *to);
/* -2 coupled, 0 free, 2 fixed, also to a body. */
int MoorDyn_GetRodType(MoorDynRod rod, int *to);
/* Force and moment about end A: of the lines, with its weight and buoyancy [N, N·m]. */
int MoorDyn_GetRodForce(MoorDynRod rod, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_GetRodM(MoorDynRod rod, double *to);
/* Number of segments. */
int MoorDyn_GetRodN(MoorDynRod rod, unsigned int *n);
/* Number of nodes. */
int MoorDyn_GetRodNumberNodes(MoorDynRod rod, unsigned int *n);
/* Position of a node [m]. */
int MoorDyn_GetRodNodePos(MoorDynRod rod, unsigned int number, double *to);
/* Velocity of a node [m/s]. */
int MoorDyn_GetRodNodeVel(MoorDynRod rod, unsigned int number, double *to);
/* No meaning here: MOORDYN_NON_IMPLEMENTED. */
int MoorDyn_SaveRodVTK(MoorDynRod rod, const char *path);

/* The water and the bed. */
/* The water at a place: the current, in still water. The bed of a file is the mooring's own. */
int MoorDyn_GetWavesKin(MoorDynWaves waves, double x, double y, double z, double *velocity, double *acceleration, double *elevation, double *pressure, MoorDynSeafloor seafloor);
/* Wave number of a frequency [rad/s] by linear theory [1/m]; 0 where there is none. */
double WaveNumber(double omega, double gravity, double depth);
/* Height of the bed at a place [m]. */
int MoorDyn_GetDepthAt(MoorDynSeafloor seafloor, double x, double y, double *depth);
/* Height of the bed at the origin [m]: it is a plane. */
int MoorDyn_GetAverageDepth(MoorDynSeafloor seafloor, double *depth);
/* Has no meaning here unless the bed is level: a plane ends nowhere. */
int MoorDyn_GetMinDepth(MoorDynSeafloor seafloor, double *depth);

/* Version 1: one mooring that the process has. */
/* Creates and initialises the mooring; one that was there before is closed. */
int MoorDynInit(const double *x, const double *xd, const char *path);
/* Goes on by a step. */
int MoorDynStep(const double *x, const double *xd, double *f, double *t, double *dt);
/* Lets go of it. */
int MoorDynClose(void);
/* Number of places for which the program gives motions of the water. */
int externalWaveKinInit(void);
/* These places. */
void getWaveKinCoordinates(double *r);
/* The motions. */
void setWaveKin(const double *u, const double *ud, double t);
/* Tension at the fairlead of a line [N]; -1 where there is none. */
double GetFairTen(int number);
/* As MoorDyn_GetFASTtens. */
int GetFASTtens(int *count, float *fairlead_across, float *fairlead_up, float *anchor_across, float *anchor_up);
/* As MoorDyn_GetPointPos. */
int GetPointPos(int number, double *to);
/* As MoorDyn_GetPointForce. */
int GetPointForce(int number, double *to);
/* As MoorDyn_GetLineNodePos. */
int GetNodePos(int line, int node, double *to);
/* Nothing: what there is to write is asked for by functions. */
void AllOutput(double t, double dt);
/* Nothing: no console is opened. */
void SetDisableConsole(int disable);

#ifdef __cplusplus
}
#endif
#endif
