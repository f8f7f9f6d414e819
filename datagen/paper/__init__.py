"""The counterparts of the figures of Petersen et al. 2014 beside its numbers, and three questions it leaves open.

- `published`: what the paper prints; `scenes`: what is simulated; `simulated`: accelerations that several figures share
- figures: `figure05_load_distribution`, `figure06_stiffness`, `figure07_contact_forces`, `figure08_velocity_spectra`,
  `figure09_envelope_spectra`, `figure10_band_spectra`, `figure11_fan_rig`
- questions: `question1_extended_profiles` (with its `profile_search`), `question2_unequal_balls`, `question3_slip`
- `chapter`: what each of these gives back; `book`: all of them; `panels`, `tables`: how they are shown
"""
