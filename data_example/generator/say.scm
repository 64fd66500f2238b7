;; Speak the sentences of the marker takes: festival -b say.scm, in an empty folder.
;; The sounds are kept in voice.ogg, the phones and words in phones.tsv.
(voice_kal_diphone)
(define (say name text stretch pitch spread)
  (Parameter.set 'Duration_Stretch stretch)
  (set! int_lr_params
        (list (list 'target_f0_mean pitch) (list 'target_f0_std spread)
              (list 'model_f0_mean 170) (list 'model_f0_std 34)))
  (set! said (utt.synth (eval (list 'Utterance 'Text text))))
  (utt.save.wave said (string-append name ".wav") 'riff)
  (utt.save.segs said (string-append name ".seg"))
  (utt.save.words said (string-append name ".wrd")))
(say "neutral" "The boy who fishes with her runs a cab." 0.83 178 20)
(say "happiness" "Oh these are huge red shells for Bob wow!" 0.79 205 34)
(say "anger" "Get your big dirty shoes off my sofa!" 0.77 192 40)
(say "sadness" "She has no hope of joy poor thing." 0.87 165 9)
(say "line" "Both of them would choose their own way of life." 0.83 185 24)
