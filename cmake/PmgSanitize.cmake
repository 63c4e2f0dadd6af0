# PMG_SANITIZE for every target from here on.
if(PMG_SANITIZE)
  add_compile_options(-fsanitize=${PMG_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PMG_SANITIZE})
  # Under AddressSanitizer Eigen aligns memory itself; libraries that free our Eigen memory (pagmo, KDL) don't know that.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
