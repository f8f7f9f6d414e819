"""Files of any kind: written whole or not at all, read with clear messages.

- `places`: where results may go; `temporary`: what to say where no temporary file can; `atomic`: absent or whole;
  `lock`: a folder for one run alone; `results`: picture, table and JSON of one name
- `digest` of a file's bytes; `plain` (data and JSON); `csv_rows` of tables that are read, `text_tables` that are
  written; `number_texts`: which texts are numbers
- `netcdf`, whose datasets are filled with ready chunks (`chunk`); `time_stamps`: what it tells of when, cleared
"""
