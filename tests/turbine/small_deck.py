"""A small OpenFAST deck, written by the tests: five stations, two airfoils, three 6x6 sections.

Figures are of the NREL 5 MW turbine (NREL/TP-500-38060), thinned out and rounded; the
layout is that of OpenFAST 3.
"""

from __future__ import annotations

from pathlib import Path

MAIN = """\
------- OpenFAST INPUT FILE -------------------------------------------
A small deck for the tests of galerna
---------------------- FEATURE SWITCHES AND FLAGS ------------------------------
          1   CompElast       - Compute structural dynamics (switch) {1=ElastoDyn; 2=BeamDyn}
          1   CompServo       - Compute control and electrical-drive dynamics (switch)
          0   CompHydro       - Compute hydrodynamic loads (switch)
          0   CompSub         - Compute sub-structural dynamics (switch)
---------------------- ENVIRONMENTAL CONDITIONS --------------------------------
        320   WtrDpth         - Water depth (m)
---------------------- INPUT FILES ---------------------------------------------
"parts/ed.dat"    EDFile          - Name of file containing ElastoDyn input parameters
"NA"              BDBldFile(1)    - Name of file containing BeamDyn input for blade 1
"parts/ad.dat"    AeroFile        - Name of file containing aerodynamic input parameters
"parts/svd.dat"   ServoFile       - Name of file containing control input parameters
"NA"              HydroFile       - Name of file containing hydrodynamic input parameters
"""

ELASTODYN = """\
------- ELASTODYN INPUT FILE -------------------------------------------
Figures of NREL/TP-500-38060
---------------------- DEGREES OF FREEDOM --------------------------------------
False         PtfmSgDOF   - Platform horizontal surge translation DOF (flag)
False         PtfmPDOF    - Platform pitch tilt rotation DOF (flag)
---------------------- TURBINE CONFIGURATION -----------------------------------
          3   NumBl       - Number of blades (-)
         63   TipRad      - The distance from the rotor apex to the blade tip (meters)
        1.5   HubRad      - The distance from the rotor apex to the blade root (meters)
       -2.5   PreCone(1)  - Blade 1 cone angle (degrees)
          0   HubCM       - Distance from rotor apex to hub mass [positive downwind] (meters)
    -5.0191   OverHang    - Distance from yaw axis to rotor apex (meters)
         -5   ShftTilt    - Rotor shaft tilt angle (degrees)
        1.9   NacCMxn     - Downwind distance from the tower-top to the nacelle CM (meters)
          0   NacCMyn     - Lateral  distance from the tower-top to the nacelle CM (meters)
       1.75   NacCMzn     - Vertical distance from the tower-top to the nacelle CM (meters)
    1.96256   Twr2Shft    - Vertical distance from the tower-top to the rotor shaft (meters)
       87.6   TowerHt     - Height of tower (meters)
          0   TowerBsHt   - Height of tower base (meters)
          0   PtfmCMxt    - Downwind distance to the platform CM (meters)
          0   PtfmCMyt    - Lateral distance to the platform CM (meters)
   -89.9155   PtfmCMzt    - Vertical distance to the platform CM (meters)
          0   PtfmRefzt   - Vertical distance to the platform reference point (meters)
---------------------- MASS AND INERTIA ----------------------------------------
      56780   HubMass     - Hub mass (kg)
     115926   HubIner     - Hub inertia about rotor axis (kg m^2)
    534.116   GenIner     - Generator inertia about HSS (kg m^2)
     240000   NacMass     - Nacelle mass (kg)
2.60789E+06   NacYIner    - Nacelle inertia about yaw axis (kg m^2)
7.46633E+06   PtfmMass    - Platform mass (kg)
4.22923E+09   PtfmRIner   - Platform inertia for roll tilt rotation about the platform CM
4.22923E+09   PtfmPIner   - Platform inertia for pitch tilt rotation about the platform CM
  1.6423E+08  PtfmYIner   - Platform inertia for yaw rotation about the platform CM
---------------------- BLADE ---------------------------------------------------
"blade.dat"    BldFile(1)  - Name of file containing properties for blade 1 (quoted string)
---------------------- DRIVETRAIN ----------------------------------------------
        100   GBoxEff     - Gearbox efficiency (%)
         97   GBRatio     - Gearbox ratio (-)
8.67637E+08   DTTorSpr    - Drivetrain torsional spring (N-m/rad)
  6.215E+06   DTTorDmp    - Drivetrain torsional damper (N-m/(rad/s))
---------------------- TOWER ---------------------------------------------------
"tower.dat"    TwrFile     - Name of file containing tower properties (quoted string)
---------------------- OUTPUT --------------------------------------------------
              OutList     - The next line(s) contains a list of output parameters.
"RotSpeed"                - Low-speed shaft speed
END of input file
"""

BLADE = """\
------- ELASTODYN INDIVIDUAL BLADE INPUT FILE --------------------------
Five of the 49 stations
          5   NBlInpSt    - Number of blade input stations (-)
   0.477465   BldFlDmp(1) - Blade flap mode #1 structural damping in percent of critical (%)
    1.04536   AdjBlMs     - Factor to adjust blade mass density (-)
          1   AdjFlSt     - Factor to adjust blade flap stiffness (-)
          1   AdjEdSt     - Factor to adjust blade edge stiffness (-)
---------------------- DISTRIBUTED BLADE PROPERTIES ----------------------------
    BlFract      PitchAxis      StrcTwst       BMassDen        FlpStff        EdgStff
      (-)           (-)          (deg)          (kg/m)         (Nm^2)         (Nm^2)
0.0000000E+00  2.5000000E-01  1.3308000E+01  6.7893500E+02  1.8110000E+10  1.8113600E+10
2.4900000E-01  3.7500000E-01  1.0162000E+01  3.3500000E+02  2.0000000E+09  4.9000000E+09
5.0000000E-01  3.7500000E-01  5.3610000E+00  2.7700000E+02  5.2900000E+08  3.2000000E+09
7.5000000E-01  3.7500000E-01  2.3190000E+00  1.5400000E+02  1.2000000E+08  1.3000000E+09
1.0000000E+00  3.7500000E-01  0.0000000E+00  1.0319000E+01  1.7000000E+05  5.0100000E+06
"""

TOWER = """\
------- ELASTODYN TOWER INPUT FILE -------------------------------------
Three of the eleven stations
          3   NTwInpSt    - Number of input stations to specify tower geometry
          1   TwrFADmp(1) - Tower 1st fore-aft mode structural damping ratio (%)
          1   AdjTwMa     - Factor to adjust tower mass density (-)
          1   AdjFASt     - Factor to adjust tower fore-aft stiffness (-)
          1   AdjSSSt     - Factor to adjust tower side-to-side stiffness (-)
---------------------- DISTRIBUTED TOWER PROPERTIES ----------------------------
  HtFract       TMassDen         TwFAStif       TwSSStif
   (-)           (kg/m)           (Nm^2)         (Nm^2)
0.0000000E+00  5.5908700E+03  6.1434300E+11  6.1434300E+11
5.0000000E-01  3.7448000E+03  2.6800000E+11  2.6800000E+11
1.0000000E+00  2.5365400E+03  1.1582000E+11  1.1582000E+11
"""

AERODYN = """\
------- AERODYN v15 for OpenFAST INPUT FILE -----------------------------------------------
Two airfoils
======  General Options  ==================================================================
          1   WakeMod            - Type of wake/induction model (switch)
======  Airfoil Information ===============================================================
          1   InCol_Alfa         - The column that contains the angle of attack (-)
          2   InCol_Cl           - The column that contains the lift coefficient (-)
          3   InCol_Cd           - The column that contains the drag coefficient (-)
          4   InCol_Cm           - The column that contains the pitching-moment coefficient
          0   InCol_Cpmin        - The column that contains the Cpmin coefficient
          2   NumAFfiles         - Number of airfoil files used (-)
"foils/round.dat"    AFNames            - Airfoil file names (NumAFfiles lines) (quoted strings)
"foils/wing.dat"
======  Rotor/Blade Properties  ===========================================================
True          UseBlCm            - Include aerodynamic pitching moment in calculations?  (flag)
"ad_blade.dat"    ADBlFile(1)        - Name of file containing distributed properties, blade #1
======  Tower Influence and Aerodynamics ==================================================
          2   NumTwrNds         - Number of tower nodes used in the analysis  (-)
TwrElev        TwrDiam        TwrCd          TwrTI          TwrCb !TwrTI used only with shadow
(m)              (m)           (-)            (-)           (-)
0.0000000E+00  6.0000000E+00  1.0000000E+00  1.0000000E-01  0.0
8.7600000E+01  3.8700000E+00  1.0000000E+00  1.0000000E-01  0.0
"""

AERODYN_BLADE = """\
------- AERODYN BLADE DEFINITION INPUT FILE -------------------------------------
Five of the 19 nodes
          5   NumBlNds           - Number of blade nodes used in the analysis (-)
  BlSpn        BlCrvAC        BlSwpAC        BlCrvAng       BlTwist        BlChord          BlAFID
   (m)           (m)            (m)            (deg)         (deg)           (m)              (-)
 0.0000E+00    0.0000E+00     0.0000E+00     0.0000E+00    13.308E+00      3.542E+00          1
15.3750E+00    0.0000E+00     0.0000E+00     0.0000E+00    11.480E+00      4.652E+00          2
30.7500E+00    0.0000E+00     0.0000E+00     0.0000E+00     6.544E+00      3.748E+00          2
46.1250E+00    0.0000E+00     0.0000E+00     0.0000E+00     3.125E+00      3.010E+00          2
61.5000E+00    0.0000E+00     0.0000E+00     0.0000E+00     0.106E+00      1.419E+00          2
"""

ROUND = """\
! ------------ AirfoilInfo v1.01.x Input File ----------------------------------
"DEFAULT"     InterpOrd         ! Interpolation order to use for quasi-steady table lookup
          0   NumCoords         ! The number of coordinates in the airfoil shape file.
          1   NumTabs           ! Number of airfoil tables in this file.
       0.75   Re                ! Reynolds number in millions
          0   UserProp          ! User property (control) setting
False         InclUAdata        ! Is unsteady aerodynamics data included in this table?
! Table of aerodynamics coefficients
          3   NumAlf            ! Number of data lines in the following table
!    Alpha      Cl      Cd        Cm
!    (deg)      (-)     (-)       (-)
   -180.00    0.000   0.5000   0.0000
      0.00    0.000   0.5000   0.0000
    180.00    0.000   0.5000   0.0000
"""

WING = """\
! ------------ AirfoilInfo v1.01.x Input File ----------------------------------
@"wing_coords.txt"    NumCoords  ! The number of coordinates in the airfoil shape file.
          1   NumTabs           ! Number of airfoil tables in this file.
       0.75   Re                ! Reynolds number in millions
True          InclUAdata        ! Is unsteady aerodynamics data included in this table?
!........................................
       -4.432   alpha0            ! 0-lift angle of attack, depends on airfoil.
        9       alpha1            ! Angle of attack at f=0.7, for AOA>alpha0. (deg)
       -9       alpha2            ! Angle of attack at f=0.7, for AOA<alpha0. (deg)
     6.0031   C_nalpha          ! Slope of the 2D normal force coefficient curve. (1/rad)
"DEFAULT"     T_f0              ! Initial value of the time constant. [default = 3]
"DEFAULT"     T_V0              ! Initial value of the time constant. [default = 6]
          1.5 T_p               ! Pressure-gradient time constant. [default = 1.7]
     1.4073   Cn1               ! Critical value of C0n at leading edge separation.
    -0.7945   Cn2               ! As Cn1 for negative AOAs.
     0.0065   Cd0               ! 2D drag coefficient value at 0-lift.
     -0.088   Cm0               ! 2D pitching moment coefficient about 1/4-chord location.
!........................................
          9   NumAlf            ! Number of data lines in the following table
!    Alpha      Cl      Cd        Cm
   -180.00    0.000   0.0198   0.0000
    -90.00   -0.160   1.3400   0.3900
    -20.00   -0.700   0.2600   0.0600
     -9.00   -0.480   0.0200  -0.0880
      0.00    0.442   0.0065  -0.1160
      9.00    1.450   0.0120  -0.1150
     20.00    1.340   0.2000  -0.1800
     90.00    0.160   1.3500  -0.4000
    180.00    0.000   0.0198   0.0000
"""

WING_COORDINATES = """\
         12   NumCoords         ! Number of coordinates, with one for the airfoil's reference
! x-y coordinate of airfoil reference
!  x/c        y/c
0.25    0
! coordinates of airfoil shape, from the trailing edge along the pressure side
 1.00   0.00
 0.75  -0.01
 0.50  -0.04
 0.25  -0.06
 0.05  -0.03
 0.00   0.00
 0.05   0.06
 0.25   0.11
 0.50   0.10
 0.75   0.06
 1.00   0.00
"""

SERVODYN = """\
------- SERVODYN INPUT FILE --------------------------------------------
Simple variable speed
          0   PCMode       - Pitch control mode {0: none, 5: user-defined from Bladed-style DLL}
          1   VSContrl     - Variable-speed control mode {1: simple VS, 5: Bladed-style DLL}
       94.4   GenEff       - Generator efficiency (%)
     1173.7   VS_RtGnSp    - Rated generator speed (HSS side) (rpm)
   43093.55   VS_RtTq      - Rated generator torque (HSS side) (N-m)
   0.025576   VS_Rgn2K     - Generator torque constant in Region 2 (HSS side) (N-m/rpm^2)
9.02832E+09   YawSpr       - Nacelle-yaw spring constant (N-m/rad)
  1.916E+07   YawDamp      - Nacelle-yaw damping constant (N-m/(rad/s))
"DISCON.IN"   DLL_InFile   - Name of input file sent to the DLL (-)
"""

DISCON = """\
! Controller parameter input file
!------- BLADE PITCH CONTROL ----------------------------------------------
1.57080             ! F_LPFCornerFreq   - Corner frequency in the low-pass filters, [rad/s]
2                   ! PC_GS_n           - Amount of gain-scheduling table entries
0.057184  0.105000  ! PC_GS_angles      - Gain-schedule table: pitch angles [rad].
-0.017430 -0.013600 ! PC_GS_KP          - Gain-schedule table: pitch controller kp gains [s].
-0.005822 -0.004750 ! PC_GS_KI          - Gain-schedule table: pitch controller ki gains [-].
1.570800000000      ! PC_MaxPit         - Maximum physical pitch limit, [rad].
0.174500000000      ! PC_MaxRat         - Maximum pitch rate in pitch controller, [rad/s].
122.9096700000      ! PC_RefSpd         - Desired (reference) HSS speed, [rad/s].
0.000000000000      ! PC_FinePit        - Below-rated pitch angle set-point, [rad]
15000.00000000      ! VS_MaxRat         - Maximum torque rate in torque controller, [Nm/s].
47402.87063000      ! VS_MaxTq          - Maximum generator torque in Region 3 (HSS side), [Nm].
70.16000000000      ! VS_MinOMSpd       - Optimal mode minimum speed, [rad/s]
2.332287000000      ! VS_Rgn2K          - Torque constant in Region 2 (HSS), [Nm/(rad/s)^2]
5000000.000000      ! VS_RtPwr          - Wind turbine rated power [W]
43093.51876000      ! VS_RtTq           - Rated torque, [Nm].
7.55                ! VS_TSRopt         - Power-maximizing region 2 tip-speed-ratio [rad].
3                   ! PS_BldPitchMin_N  - Number of values in minimum blade pitch lookup table
3.00 11.4 25.0      ! PS_WindSpeeds     - Wind speeds of minimum blade pitch angles, [m/s].
-0.0175 0.0 0.0     ! PS_BldPitchMin    - Minimum blade pitch angles, [rad].
"""

BEAMDYN = """\
--------- BEAMDYN INPUT FILE -------------------------------------------
A slightly prebent axis
---------------------- GEOMETRY PARAMETER --------------------------------------
          1   member_total    - Total number of members (-)
          3   kp_total        - Total number of key points (-) [must be at least 3]
     1     3                 - Member number; Number of key points in this member
         kp_xr           kp_yr           kp_zr         initial_twist
          (m)             (m)             (m)             (deg)
         0.0             0.0             0.0             13.308
        -0.1             0.0            30.75             6.544
        -1.0             0.0            61.5              0.106
---------------------- MATERIAL PARAMETER --------------------------------------
"bd_blade.dat"    BldFile - Name of file containing properties for blade (quoted string)
"""


def beamdyn_blade(count: int | str = 3) -> str:
    """Three sections; the mass centre lies 0.2 m behind the axis and couples as it must."""
    lines = [
        " ------- BEAMDYN INDIVIDUAL BLADE INPUT FILE --------------------------",
        "Three sections",
        f"{count}   station_total    - Number of blade input stations (-)",
        " 1   damp_type        - Damping type: 0: no damping; 1: damped",
        "   mu1        mu2        mu3        mu4        mu5        mu6",
        "   (-)        (-)        (-)        (-)        (-)        (-)",
        "1.0E-03    1.0E-03    1.0E-03    0.0014     0.0022     0.0022",
        " ---------------------- DISTRIBUTED PROPERTIES---------------------------------",
    ]
    for eta, factor in ((0.0, 1.0), (0.5, 0.2), (1.0, 0.01)):
        mass, behind = 500.0 * factor, 0.2
        stiffness = [1e9, 1e9, 1e10, 2e10, 1e10, 5e9]
        matrix = [
            [s * factor if i == j else 0.0 for j in range(6)] for i, s in enumerate(stiffness)
        ]
        inertia = [[0.0] * 6 for _ in range(6)]
        for i, value in enumerate((mass, mass, mass, mass * 2, mass, mass * 3)):
            inertia[i][i] = value
        inertia[0][5] = inertia[5][0] = -mass * behind
        inertia[2][3] = inertia[3][2] = mass * behind
        lines.append(f"  {eta:.6f}")
        for rows in (matrix, inertia):
            lines += ["   ".join(f"{v:.8E}" for v in row) for row in rows] + [""]
    return "\n".join(lines) + "\n"


FILES = {
    "small.fst": MAIN,
    "parts/ed.dat": ELASTODYN,
    "parts/blade.dat": BLADE,
    "parts/tower.dat": TOWER,
    "parts/ad.dat": AERODYN,
    "parts/ad_blade.dat": AERODYN_BLADE,
    "parts/svd.dat": SERVODYN,
    "parts/DISCON.IN": DISCON,
    "parts/foils/round.dat": ROUND,
    "parts/foils/wing.dat": WING,
    "parts/foils/wing_coords.txt": WING_COORDINATES,
    "parts/bd.dat": BEAMDYN,
    "parts/bd_blade.dat": beamdyn_blade(),
}


def write_deck(folder: Path) -> Path:
    """Write the deck into a folder and return its .fst file."""
    for name, text in FILES.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder / "small.fst"


def edit(fst: Path, file: str, old: str, new: str) -> None:
    """Replace a piece of one file of a deck that ``write_deck`` wrote; it must be there."""
    path = fst.parent / file
    text = path.read_text()
    assert old in text, f"{old!r} is not in {file}"
    path.write_text(text.replace(old, new))
