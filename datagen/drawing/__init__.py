"""Every picture that commands draw.

- `preview`: one record on one sheet; a `portrait` is what its `sheet` shows, made of `time_panels`, `frequency_panels`
  and `path_panels`; `decibel_panel`: power over time and frequency; `portrait_sources`: where a portrait comes from;
  `close_up`: the stretch shown enlarged
- `measured_portrait`, `measured_sheet`: the same of an imported recording
- `overview`: a whole corpus
- `classifier_sheet` and its `classifier_panels`: scores of classifiers; `size_report`: of spall sizes
- `work_precision`: speed against accuracy; `stability_map`: where methods fail
- `style`: one look for all
"""
