; KISSlicer - FREE
; version 2 a 2.0.6 Win64
G21
G90
M83
; BEGIN_LAYER_OBJECT z=0.200 z_thickness=0.200
G1 Z0.2 E0 F300
; 'Travel/Ironing Path', 0.0 [feed mm/s], 150.0 [head mm/s]
G1 X10 Y10 E0 F9000
; 'Perimeter Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X30 Y10 E0.66
G1 X30 Y30 E0.66
G1 X10 Y30 E0.66
G1 X10 Y10 E0.66
; 'Travel/Ironing Path', 0.0 [feed mm/s], 150.0 [head mm/s]
G1 X10.4 Y10.4 E0 F9000
; 'Loop Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X29.6 Y10.4 E0.6336
G1 X29.6 Y29.6 E0.6336
G1 X10.4 Y29.6 E0.6336
G1 X10.4 Y10.4 E0.6336
; 'Destring Suck'
G1 E-1 F1800
G1 X50 Y10 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Perimeter Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X70 Y10 E0.66
G1 X70 Y30 E0.66
G1 X50 Y30 E0.66
G1 X50 Y10 E0.66
; 'Travel/Ironing Path', 0.0 [feed mm/s], 150.0 [head mm/s]
G1 X50.4 Y10.4 E0 F9000
; 'Loop Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X69.6 Y10.4 E0.6336
G1 X69.6 Y29.6 E0.6336
G1 X50.4 Y29.6 E0.6336
G1 X50.4 Y10.4 E0.6336
; 'Destring Suck'
G1 E-1 F1800
G1 X12 Y14 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X28 Y14 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X52 Y26 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X68 Y26 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X12 Y26 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X28 Y26 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X52 Y14 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X68 Y14 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X12 Y20 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X28 Y20 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X52 Y20 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X68 Y20 E0.528
; END_LAYER_OBJECT z=0.200
; BEGIN_LAYER_OBJECT z=0.400 z_thickness=0.200
G1 Z0.4 E0 F300
; 'Destring Suck'
G1 E-1 F1800
G1 X10 Y10 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Perimeter Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X30 Y10 E0.66
G1 X30 Y30 E0.66
G1 X10 Y30 E0.66
G1 X10 Y10 E0.66
; 'Travel/Ironing Path', 0.0 [feed mm/s], 150.0 [head mm/s]
G1 X10.4 Y10.4 E0 F9000
; 'Loop Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X29.6 Y10.4 E0.6336
G1 X29.6 Y29.6 E0.6336
G1 X10.4 Y29.6 E0.6336
G1 X10.4 Y10.4 E0.6336
; 'Destring Suck'
G1 E-1 F1800
G1 X50 Y10 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Perimeter Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X70 Y10 E0.66
G1 X70 Y30 E0.66
G1 X50 Y30 E0.66
G1 X50 Y10 E0.66
; 'Travel/Ironing Path', 0.0 [feed mm/s], 150.0 [head mm/s]
G1 X50.4 Y10.4 E0 F9000
; 'Loop Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X69.6 Y10.4 E0.6336
G1 X69.6 Y29.6 E0.6336
G1 X50.4 Y29.6 E0.6336
G1 X50.4 Y10.4 E0.6336
; 'Destring Suck'
G1 E-1 F1800
G1 X12 Y14 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X28 Y14 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X52 Y26 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X68 Y26 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X12 Y26 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X28 Y26 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X52 Y14 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X68 Y14 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X12 Y20 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X28 Y20 E0.528
; 'Destring Suck'
G1 E-1 F1800
G1 X52 Y20 E0 F9000
; 'Destring Prime'
G1 E1 F1800
; 'Sparse Infill Path', 0.7 [feed mm/s], 30.0 [head mm/s]
G1 F1800
G1 X68 Y20 E0.528
; END_LAYER_OBJECT z=0.400
G1 E-1 F1800
